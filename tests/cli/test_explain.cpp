// `sahl explain` beside the image that `sahl render` writes.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

nlohmann::json explained(const std::vector<std::string>& arguments) {
    const ProcessResult result = run_sahl(arguments);
    INFO(result.err);
    REQUIRE(result.status == 0);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    CHECK(events[0].at("event") == "explanation");
    return events[0];
}

}  // namespace

TEST_CASE("explain: the colour is the rendered pixel's, and each ray says what it gives", "[cli][explain]") {
    const TemporaryFolder folder;
    const std::string image = (folder.path() / "image.exr").string();
    const std::vector<std::string> view{"--size", "64x48", "--depth", "3", "--spp", "2", "--seed", "5"};
    std::vector<std::string> render{"render", scene_file("all_entities.nff"), "-o", image, "--pixel-type",
                                    "float"};
    render.insert(render.end(), view.begin(), view.end());
    REQUIRE(run_sahl(render).status == 0);
    const Image pixels = read_image(image);

    std::vector<std::string> arguments{"explain", scene_file("all_entities.nff"), "--pixel", "31,30",
                                       "--json"};
    arguments.insert(arguments.end(), view.begin(), view.end());
    const nlohmann::json event = explained(arguments);
    for (std::size_t c = 0; c < 3; ++c) {
        CHECK(event.at("color").at(c).get<float>() == pixels.pixels.at(3 * (30 * 64 + 31) + c));
    }
    std::array<std::int64_t, 3> sum{};
    std::size_t of_generations = 0;
    for (const nlohmann::json& generation : event.at("generations")) {
        of_generations += generation.at("rays").get<std::size_t>();
        for (std::size_t c = 0; c < 3; ++c) sum.at(c) += generation.at("fixed").at(c).get<std::int64_t>();
    }
    CHECK(event.at("fixed") == nlohmann::json(sum));
    const nlohmann::json& rays = event.at("rays");
    CHECK(of_generations == rays.size());
    CHECK(rays.size() > 2);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const nlohmann::json& ray = rays[i];
        const bool is_camera = ray.at("from") == "camera";
        CHECK(ray.at("parent").is_null() == is_camera);
        CHECK((is_camera || ray.at("parent").get<std::size_t>() < i));
        CHECK(ray.at("lights").size() == (ray.at("primitive").is_null() ? 0 : 2));
        for (std::size_t c = 0; c < 3; ++c) {
            double given = ray.at("own").at(c).get<double>();
            for (const nlohmann::json& light : ray.at("lights")) {
                CHECK(light.at("arriving").at(c).get<double>() <= light.at("unshadowed").at(c).get<double>());
                given += light.at("arriving").at(c).get<double>();
            }
            CHECK(ray.at("contribution").at(c).get<double>() == Approx(given).margin(1e-9));
        }
    }
}

TEST_CASE("explain: neither tree nor traversal changes the rays, and memory is limited", "[cli][explain]") {
    const std::vector<std::string> plain{
        "explain", scene_file("all_entities.nff"), "--pixel", "31,30", "--size", "64x48", "--json"};
    std::vector<std::string> other = plain;
    other.insert(other.end(), {"--build-quality", "fast", "--traversal", "stream", "--max-mem", "200M"});
    CHECK(explained(other) == explained(plain));
    // The way is taken: without its kernel there is none.
    const TemporaryFolder folder;
    fs::copy(fs::path(std::getenv("SAHL_SOURCE_DIR")) / "kernels", folder / "kernels");
    fs::remove(folder / "kernels" / "intersect_stream.cl");
    ProcessOptions without;
    without.environment["SAHL_KERNEL_DIR"] = (folder / "kernels").string();
    const ProcessResult missing = run_sahl(other, without);
    CHECK(missing.status != 0);
    CHECK(contains(missing.err, "intersect_stream.cl"));
    std::vector<std::string> tight = plain;
    tight.insert(tight.end(), {"--max-mem", "10K"});
    const ProcessResult refused = run_sahl(tight);
    CHECK(refused.status == 5);
    CHECK(contains(refused.err, "--max-mem"));
}

TEST_CASE("explain: the text has the tree and the sums", "[cli][explain]") {
    const ProcessResult result =
        run_sahl({"explain", scene_file("all_entities.nff"), "--pixel", "31,30", "--size", "64x48"});
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    CHECK(contains(result.out, "pixel 31,30 of "));
    CHECK(contains(result.out, "\ncamera "));
    CHECK(contains(result.out, "in units of 2^-32"));
    CHECK(contains(result.out, "the pixel's colour is the sum over 1: "));
}

TEST_CASE("explain: pixels that are not there are refused", "[cli][explain]") {
    const std::string scene = scene_file("all_entities.nff");
    const auto refused = [&scene](const std::vector<std::string>& more, const std::string& reason) {
        std::vector<std::string> arguments{"explain", scene};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run_sahl(arguments);
        INFO(result.err);
        CHECK(result.status == 2);
        CHECK(contains(result.err, reason));
    };
    refused({"--pixel", "64,0", "--size", "64x48"}, "--pixel 64,0 is outside the image, which is 64x48");
    refused({"--pixel", "0,48", "--size", "64x48"}, "--pixel 0,48 is outside");
    refused({"--pixel", "5"}, "--pixel '5': X,Y");
    refused({"--pixel", "1,-1"}, "--pixel '-1': a whole number");
    refused({"--pixel", "1,1", "--depth", "1,2"}, "--depth: a pixel is explained at one depth");
    refused({}, "--pixel is required");
}

}  // namespace sahl::tests
