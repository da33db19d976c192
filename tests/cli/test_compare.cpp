// `sahl compare`: what it reports and the exit statuses that scripts rely on.
#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

/// 8-bit images of 10x10 pixels: grey 100, the first `count` pixels `steps` brighter in green.
void write_grey(const std::filesystem::path& path, int count, int steps) {
    Image image{10, 10, 3, std::vector<float>(300, 100 / 255.0F)};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        image.pixels[3 * i + 1] = static_cast<float>(100 + steps) / 255.0F;
    }
    OutputSettings settings;
    settings.transfer = Transfer::linear;
    write_image(path, image, settings);
}

/// a.png grey, b.png with 3 pixels of 100 that are 5 steps brighter.
struct Pair {
    TemporaryFolder folder;

    Pair() {
        write_grey(folder.path() / "a.png", 0, 0);
        write_grey(folder.path() / "b.png", 3, 5);
    }
    ProcessResult compare(std::vector<std::string> more, const std::string& other = "b.png") const {
        more.insert(more.begin(), {"compare", "a.png", other});
        return run_sahl_in(folder.path(), more);
    }
};

TEST_CASE("compare: equal images pass", "[cli]") {
    const Pair pair;
    const ProcessResult result = pair.compare({}, "a.png");
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.err == "");
    CHECK(contains(result.out, "pixels over 0: 0 of 100"));
    CHECK(pair.compare({"-q"}, "a.png").out == "");
}

TEST_CASE("compare: the exit status is 1 above the limits and 0 at them", "[cli]") {
    const Pair pair;
    struct Case {
        std::vector<std::string> limits;
        int status;
    };
    const auto item = GENERATE(values<Case>({
        {{}, 1},
        {{"--threshold", "4/255"}, 1},
        {{"--threshold", "5/255"}, 0},
        {{"--threshold", "0.1"}, 0},
        {{"--max-pixels", "2"}, 1},
        {{"--max-pixels", "3"}, 0},
        {{"--max-pixels", "2.9%"}, 1},
        {{"--max-pixels", "3%"}, 0},
        {{"--threshold", "4/255", "--max-pixels", "2"}, 1},
        {{"--threshold", "4/255", "--max-pixels", "3", "-q"}, 0},
    }));
    const ProcessResult result = pair.compare(item.limits);
    INFO(result.out << result.err);
    CHECK(result.status == item.status);
}

TEST_CASE("compare: --json has the figures", "[cli]") {
    const Pair pair;
    const ProcessResult result = pair.compare({"--json", "--threshold", "2/255"});
    CHECK(result.status == 1);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    const nlohmann::json& event = events[0];
    CHECK(event.at("max_difference").get<double>() == Approx(5 / 255.0));
    CHECK(event.at("mean_difference").get<double>() == Approx(3 * 5 / 255.0 / 300));
    CHECK(event.at("mse").get<double>() == Approx(3 * 25 / 65025.0 / 300));
    CHECK(event.at("pixels") == 100);
    CHECK(event.at("pixels_over") == 3);
    CHECK(event.at("passed") == false);
    // Equal images: an infinite PSNR, which JSON does not have.
    CHECK(json_lines(pair.compare({"--json"}, "a.png").out).at(0).at("psnr").is_null());
}

TEST_CASE("compare: --mask leaves pixels out", "[cli]") {
    const Pair pair;
    Image mask{10, 10, 3, std::vector<float>(300, 1.0F)};
    std::fill_n(mask.pixels.begin(), 9, 0.0F);  // the three pixels that differ
    write_image(pair.folder.path() / "mask.png", mask, {});
    const ProcessResult result = pair.compare({"--mask", "mask.png", "--json"});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(json_lines(result.out).at(0).at("pixels") == 97);
}

TEST_CASE("compare: --diff writes the differences themselves", "[cli]") {
    const Pair pair;
    CHECK(pair.compare({"--diff", "d.exr"}).status == 1);
    const Image difference = read_image(pair.folder.path() / "d.exr");
    REQUIRE(difference.pixels.size() == 300);
    CHECK(difference.pixels[1] == Approx(5 / 255.0).epsilon(1e-3));
    CHECK(difference.pixels[0] == 0);
    CHECK(difference.pixels[9 + 1] == 0);
    CHECK(pair.compare({"--diff", "d.png"}).status == 1);
    CHECK(read_image(pair.folder.path() / "d.png").pixels[1] == Approx(5 / 255.0));
}

TEST_CASE("compare: other sizes are 1, files that are missing or no images 3, bad output 6", "[cli]") {
    const Pair pair;
    write_image(pair.folder.path() / "small.png", Image{2, 2, 3, std::vector<float>(12, 0.0F)}, {});
    write_file(pair.folder.path() / "text.png", "no image");
    CHECK(pair.compare({}, "small.png").status == 1);
    CHECK(pair.compare({}, "missing.png").status == 3);
    CHECK(pair.compare({}, "text.png").status == 3);
    CHECK(pair.compare({"--mask", "small.png"}).status == 2);
    const ProcessResult result = pair.compare({"--diff", "a.png/d.png"});
    INFO(result.err);
    CHECK(result.status == 6);
    CHECK(contains(result.err, "a.png/d.png"));
}

TEST_CASE("compare: limits that cannot be meant are exit status 2", "[cli]") {
    const Pair pair;
    for (const std::string threshold : {"-1", "x", "", "1/0", "1/2/3", "nan", "2%"}) {
        CHECK(pair.compare({"--threshold", threshold}).status == 2);
    }
    for (const std::string limit : {"-1", "x", "", "1.5", "101%", "%"}) {
        CHECK(pair.compare({"--max-pixels", limit}).status == 2);
    }
    CHECK(pair.compare({"--diff", "d.xyz"}).status == 2);
}

}  // namespace
}  // namespace sahl::tests
