// `sahl render` as a user meets it: files, names, series, crops, events, failures.
#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

std::string mirrors() { return scene_file("cli_mirrors.nff"); }

/// Runs `sahl render` in `folder`; it has to succeed.
ProcessResult render_in(const fs::path& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    ProcessResult result = run_sahl_in(folder, arguments);
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    return result;
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

TEST_CASE("render: the default image is named after the scene and lies in the current folder", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = render_in(folder.path(), {mirrors()});
    CHECK(result.out == "");
    CHECK(result.err.starts_with("wrote cli_mirrors.png  48x32, depth 4, 1 spp, "));
    CHECK(contains(result.err, "rays/s\n"));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"cli_mirrors.png"});
    const Image image = read_image(folder.path() / "cli_mirrors.png");
    CHECK(image.width == 48);
    CHECK(image.height == 32);
}

TEST_CASE("render: -q says nothing", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = render_in(folder.path(), {mirrors(), "-q"});
    CHECK(result.out == "");
    CHECK(result.err == "");
}

TEST_CASE("render: -v says more", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = render_in(folder.path(), {"-v", mirrors()});
    CHECK(result.out == "");
    CHECK(contains(result.err, "sahl: debug: device "));
    CHECK(contains(result.err, "primitives"));
}

TEST_CASE("render: a series of depths in one command is the images of single commands", "[cli]") {
    const TemporaryFolder folder;
    render_in(folder.path(), {mirrors(), "--depth", "0,2,7", "-o", "d{depth}.exr"});
    CHECK(names_in(folder.path()) == std::vector<std::string>{"d0.exr", "d2.exr", "d7.exr"});
    for (const std::string depth : {"0", "2", "7"}) {
        render_in(folder.path(), {mirrors(), "--depth", depth, "-o", "single.exr"});
        CHECK(read_image(folder.path() / "single.exr").pixels ==
              read_image(folder.path() / fmt::format("d{}.exr", depth)).pixels);
    }
    CHECK(read_image(folder.path() / "d0.exr").pixels != read_image(folder.path() / "d2.exr").pixels);
}

TEST_CASE("render: one depth fills in {depth}, the scene's too", "[cli]") {
    const TemporaryFolder folder;
    render_in(folder.path(), {mirrors(), "-o", "{depth}.png"});
    CHECK(names_in(folder.path()) == std::vector<std::string>{"4.png"});
}

TEST_CASE("render: a crop is that part of the whole image, bit for bit", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> settings{"--spp", "4", "--seed", "7", "--pixel-type", "float"};
    std::vector<std::string> whole{mirrors(), "-o", "whole.exr"};
    std::vector<std::string> crop{mirrors(), "-o", "crop.exr", "--crop", "11,5,31,29"};
    whole.insert(whole.end(), settings.begin(), settings.end());
    crop.insert(crop.end(), settings.begin(), settings.end());
    render_in(folder.path(), whole);
    const ProcessResult result = render_in(folder.path(), crop);
    CHECK(contains(result.err, "20x24"));

    const Image all = read_image(folder.path() / "whole.exr");
    const Image part = read_image(folder.path() / "crop.exr");
    REQUIRE(part.width == 20);
    REQUIRE(part.height == 24);
    REQUIRE(all.channels == part.channels);
    const auto row_size = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.channels);
    int different_rows = 0;
    for (int y = 0; y < part.height; ++y) {
        const float* expected = all.pixels.data() + ((y + 5) * all.width + 11) * all.channels;
        const float* row = part.pixels.data() + y * part.width * part.channels;
        if (!std::equal(row, row + row_size, expected)) ++different_rows;
    }
    CHECK(different_rows == 0);
}

TEST_CASE("render: --exposure brightens, --size and --spp are obeyed", "[cli]") {
    const TemporaryFolder folder;
    const auto render_file = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.begin(), {mirrors(), "-o", name, "--pixel-type", "float"});
        render_in(folder.path(), more);
        return read_image(folder.path() / name);
    };
    const Image plain = render_file("plain.exr", {"--size", "20x10"});
    CHECK(plain.width == 20);
    CHECK(plain.height == 10);
    const Image bright = render_file("bright.exr", {"--size", "20x10", "--exposure", "-1"});
    REQUIRE(bright.pixels.size() == plain.pixels.size());
    int different = 0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        different += bright.pixels[i] != plain.pixels[i] / 2;
    CHECK(different == 0);
    CHECK(render_file("samples.exr", {"--size", "20x10", "--spp", "5"}).pixels != plain.pixels);
}

TEST_CASE("render: the samples' halves have the whole as their mean", "[cli]") {
    const TemporaryFolder folder;
    const auto rendered = [&](const std::string& name, const std::vector<std::string>& samples) {
        std::vector<std::string> arguments{mirrors(), "-o", name,           "--size", "24x16",
                                           "--spp",   "16", "--pixel-type", "float"};
        arguments.insert(arguments.end(), samples.begin(), samples.end());
        render_in(folder.path(), arguments);
        return read_image(folder.path() / name);
    };
    const Image whole = rendered("whole.exr", {});
    const Image first = rendered("first.exr", {"--samples", "0..8"});
    const Image second = rendered("second.exr", {"--samples", "8..16"});
    CHECK(first.pixels != second.pixels);
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        REQUIRE((first.pixels[i] + second.pixels[i]) / 2 ==
                Approx(whole.pixels[i]).epsilon(1e-6).margin(1e-7));
}

TEST_CASE("render: --json tells what was done, line by line", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result =
        render_in(folder.path(), {mirrors(), "--json", "--depth", "0,3", "-o", "d{depth}.png", "--spp", "2"});
    CHECK(contains(result.err, "wrote d0.png"));
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 3);
    CHECK(events[0].at("event") == "start");
    CHECK(events[0].at("width") == 48);
    CHECK(events[0].at("depths") == nlohmann::json({0, 3}));
    CHECK(events[0].at("device").get<std::string>() != "");
    for (std::size_t i : {1U, 2U}) {
        const nlohmann::json& image = events[i];
        const int depth = i == 1 ? 0 : 3;
        CHECK(image.at("event") == "image");
        CHECK(image.at("path") == fmt::format("d{}.png", depth));
        CHECK(image.at("depth") == depth);
        CHECK(image.at("spp") == 2);
        CHECK(image.at("seconds").get<double>() >= 0);
        const nlohmann::json& generations = image.at("generations");
        REQUIRE(generations.size() == static_cast<std::size_t>(depth) + 1);
        CHECK(generations[0].at("rays") == 48 * 32 * 2);
        for (const char* kind : {"rays", "shadow_rays"}) {
            std::uint64_t sum = 0;
            for (const nlohmann::json& generation : generations)
                sum += generation.at(kind).get<std::uint64_t>();
            CHECK(image.at(kind) == sum);
        }
    }
}

TEST_CASE("render: paths with spaces and UTF-8", "[cli]") {
    const TemporaryFolder folder;
    const fs::path room = folder.path() / "Ибн Сахл 光";
    fs::create_directory(room);
    fs::copy_file(mirrors(), room / "eine Szene ü.nff");
    render_in(room, {"eine Szene ü.nff", "--size", "8x8"});
    CHECK(fs::exists(room / "eine Szene ü.png"));
    const ProcessResult result = render_in(folder.path(), {"--json", (room / "eine Szene ü.nff").string(),
                                                           "--size", "8x8", "-o", room / "[1] 光.png"});
    CHECK(fs::exists(room / "[1] 光.png"));
    CHECK(json_lines(result.out).back().at("path") == (room / "[1] 光.png").string());
}

TEST_CASE("render: an error in the scene says where, exit status 3", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder.path() / "bad.nff", "f 1 1 1 1 0 0 0 0\ns 1 2 three 4\n");
    const ProcessResult result = run_sahl_in(folder.path(), {"render", "bad.nff"});
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(contains(result.err, "sahl: error: bad.nff:2:7: "));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"bad.nff"});
}

TEST_CASE("render: a scene file that is not there, or is a folder, is exit status 3", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult missing = run_sahl_in(folder.path(), {"render", "missing.nff", "--json"});
    CHECK(missing.status == 3);
    CHECK(contains(missing.err, "missing.nff"));
    const std::vector<nlohmann::json> events = json_lines(missing.out);
    REQUIRE(events.size() == 1);
    CHECK(events[0].at("event") == "error");
    CHECK(events[0].at("code") == 3);
    CHECK(contains(events[0].at("message"), "missing.nff"));

    fs::create_directory(folder.path() / "folder.nff");
    CHECK(run_sahl_in(folder.path(), {"render", "folder.nff"}).status == 3);
}

TEST_CASE("render: an image that cannot be written is exit status 6, before any work", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder.path() / "file", "");
    fs::create_directory(folder.path() / "folder.png");
    for (const std::string output : {"file/image.png", "folder.png"}) {
        const ProcessResult result =
            run_sahl_in(folder.path(), {"render", mirrors(), "-o", output, "--json"});
        INFO(output << ": " << result.err);
        CHECK(result.status == 6);
        CHECK(contains(result.err, output));
        const std::vector<nlohmann::json> events = json_lines(result.out);
        REQUIRE(events.size() == 1);  // not even started
        CHECK(events[0].at("code") == 6);
    }
    // Only the attempt shows that there are no new files in /proc.
    CHECK(run_sahl_in(folder.path(), {"render", mirrors(), "-o", "/proc/sahl.png"}).status == 6);
}

TEST_CASE("render: events that nobody takes are exit status 6", "[cli]") {
    ProcessOptions options;
    const TemporaryFolder folder;
    options.working_directory = folder.path();
    options.standard_output = "/dev/full";
    const ProcessResult result = run_sahl({"render", mirrors(), "--json"}, options);
    INFO(result.err);
    CHECK(result.status == 6);
}

}  // namespace
}  // namespace sahl::tests
