// `sahl render`: several images in one run, AOVs that are refused, compressions, cameras.
#include <OpenImageIO/imageio.h>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

ProcessResult render_mirrors_in(const fs::path& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", scene_file("cli_mirrors.nff")});
    return run_sahl_in(folder, arguments);
}

/// Fails with 2, says so, and leaves nothing.
void check_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    const TemporaryFolder folder;
    const ProcessResult result = render_mirrors_in(folder.path(), arguments);
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(result.out == "");
    for (const std::string& part : parts) {
        INFO(part);
        CHECK(contains(result.err, part));
    }
    CHECK(folder.entries() == 0);
}

OIIO::ImageSpec image_spec(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    return input->spec();
}

TEST_CASE("outputs: several images of one run are those of single runs, bit for bit", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = render_mirrors_in(
        folder.path(), {"-o", "a.exr", "-o", "a.png", "--output", "sub/a.tif", "--exposure", "1", "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    CHECK(folder.entries() == 3);
    CHECK(contains(result.err, "wrote a.exr, a.png, sub/a.tif  48x32"));
    const nlohmann::json event = json_lines(result.out).at(1);
    CHECK(event.at("paths") == nlohmann::json({"a.exr", "a.png", "sub/a.tif"}));
    CHECK(event.at("path") == "a.exr");
    for (const std::string name : {"a.exr", "a.png", "sub/a.tif"}) {
        const std::string single = "single" + fs::path(name).extension().string();
        REQUIRE(render_mirrors_in(folder.path(), {"-o", single, "--exposure", "1"}).status == 0);
        CHECK(read_image(folder / name).pixels == read_image(folder / single).pixels);
        REQUIRE(render_mirrors_in(folder.path(), {"-o", single}).status == 0);
        CHECK(read_image(folder / name).pixels != read_image(folder / single).pixels);  // all are exposed
    }
}

TEST_CASE("outputs: a series in several formats", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = render_mirrors_in(
        folder.path(), {"--depth", "0,3", "-o", "d{depth}.exr", "-o", "{depth}/p.png", "--json", "-q"});
    REQUIRE(result.status == 0);
    for (const char* name : {"d0.exr", "d3.exr", "0/p.png", "3/p.png"}) CHECK(fs::exists(folder / name));
    CHECK(folder.entries() == 4);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 3);
    CHECK(events[2].at("paths") == nlohmann::json({"d3.exr", "3/p.png"}));
}

TEST_CASE("outputs: two images of one name, or a series without {depth} in one", "[cli]") {
    check_refused({"-o", "a.png", "-o", "a.png"}, {"-o 'a.png'", "a name of its own"});
    check_refused({"-o", "a.png", "-o", "b/../a.png"}, {"a name of its own"});
    check_refused({"--depth", "1,11", "-o", "{depth}.png", "-o", "{depth}{depth}.png"}, {"'11.png'"});
    check_refused({"--depth", "0,1", "-o", "{depth}.png", "-o", "a.exr"}, {"{depth}"});
    check_refused({"-o", "a.png", "-o", "a.xyz"}, {"a.xyz", ".exr"});
}

TEST_CASE("outputs: each is checked before rendering", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "file", "");
    const ProcessResult result =
        render_mirrors_in(folder.path(), {"-o", "a.png", "-o", "file/b.png", "--json"});
    INFO(result.err);
    CHECK(result.status == 6);
    CHECK(contains(result.err, "file/b.png"));
    CHECK(json_lines(result.out).size() == 1);
    CHECK(folder.entries() == 1);
}

TEST_CASE("outputs: settings go to the images that can hold them", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(render_mirrors_in(folder.path(),
                              {"-o", "a.exr", "-o", "a.png", "-o", "a.tif", "--pixel-type", "uint16",
                               "--transfer", "srgb", "--rounding", "floor", "--compression", "piz"})
                .status == 0);
    CHECK(image_spec(folder / "a.exr").format == OIIO::TypeDesc::HALF);
    CHECK(image_spec(folder / "a.exr").get_string_attribute("compression") == "piz");
    CHECK(image_spec(folder / "a.png").format == OIIO::TypeDesc::UINT16);
    CHECK(image_spec(folder / "a.tif").format == OIIO::TypeDesc::UINT16);

    check_refused({"-o", "a.jpg", "-o", "a.png", "--pixel-type", "half"},
                  {"pixel type half fits none", "'a.jpg' holds uint8", "'a.png' holds uint8, uint16"});
    check_refused({"-o", "a.jpg", "-o", "a.png", "--compression", "piz"}, {"jpeg:1..100", "zip:0..9"});
    check_refused({"-o", "a.jpg", "--compression", "piz"}, {"'piz' does not fit", "jpeg:1..100"});
    check_refused({"-o", "a.jpg", "--compression", "jpeg:101"}, {"jpeg:1..100"});
    check_refused({"-o", "a.exr", "--compression", "zipp"}, {"--compression 'zipp'", "zips, zip, piz"});
    check_refused({"-o", "a.exr", "--rounding", "floor"}, {"not rounded"});
    check_refused({"-o", "a.exr", "-o", "a.hdr", "--transfer", "srgb"}, {"'a.hdr' has float pixels"});
}

TEST_CASE("outputs: AOVs that are not there, or have no room", "[cli]") {
    check_refused({"-o", "a.exr", "--aov", "depth"}, {"--aov 'depth'", "Z, N, albedo, id.primitive"});
    check_refused({"-o", "a.exr", "--aov", "Z,Z"}, {"each AOV once"});
    check_refused({"-o", "a.exr", "--aov", "Z,"}, {"--aov"});
    check_refused({"-o", "a.exr", "--aov", "all,Z"}, {"--aov 'all,Z': 'all' stands alone"});
    check_refused({"-o", "a.exr", "--aov", "Z,all"}, {"--aov 'Z,all': 'all' stands alone"});
    check_refused({"--aov", "Z"}, {"'cli_mirrors.png' has no room for AOVs", "-o 'cli_mirrors.exr'"});
    check_refused({"-o", "a.png", "-o", "b.tif", "--aov", "all"}, {"-o 'a.exr'"});
}

TEST_CASE("outputs: the camera's name is in the file and the start event", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result =
        render_mirrors_in(folder.path(), {"--camera", "camera", "-o", "a.exr", "-o", "a.png", "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    CHECK(json_lines(result.out).at(0).at("camera") == "camera");
    for (const char* name : {"a.exr", "a.png"})
        CHECK(image_spec(folder / name).get_string_attribute("Sahl:Camera") == "camera");
    check_refused({"--camera", "camra"}, {"--camera 'camra'", "did you mean 'camera'?", "it has camera"});
}

TEST_CASE("outputs: exposure and parameters are in the file if they were given", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "a.json", R"({
  "sahl": 1,
  "film": {"width": 2, "height": 2},
  "parameters": {"glow": {"type": "color", "default": 0}, "size": {"type": "number", "default": 1}},
  "cameras": {"main": {"eye": [0, 0, 9], "look_at": [0, 0, 0]}},
  "objects": [{"type": "sphere", "radius": "$size", "material": {"emission": "$glow"}}]
})");
    const std::vector<std::string> plain{"render", "a.json", "-o", "a.exr", "-o", "a.png"};
    REQUIRE(run_sahl_in(folder.path(), plain).status == 0);
    for (const char* name : {"a.exr", "a.png"}) {
        CHECK(image_spec(folder / name).find_attribute("Sahl:Exposure") == nullptr);
        CHECK(image_spec(folder / name).find_attribute("Sahl:Parameters") == nullptr);
    }
    std::vector<std::string> given = plain;
    given.insert(given.end(), {"--exposure", "-1.5", "--set", "glow=1,0.5,0", "--set", "size=2"});
    REQUIRE(run_sahl_in(folder.path(), given).status == 0);
    for (const char* name : {"a.exr", "a.png"}) {
        CHECK(image_spec(folder / name).get_string_attribute("Sahl:Exposure") == "-1.5");
        CHECK(image_spec(folder / name).get_string_attribute("Sahl:Parameters") == "glow=1,0.5,0 size=2");
    }
}

TEST_CASE("outputs: a scene's cameras, its first by default", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "a.json", R"({
  "sahl": 1,
  "film": {"width": 9, "height": 9},
  "depth": 0,
  "parameters": {"glow": {"type": "color", "default": 0}},
  "cameras": {"front": {"eye": [0, 0, 9], "look_at": [0, 0, 0]},
              "back": {"eye": [0, 0, -9], "look_at": [0, 0, -20]}},
  "objects": [{"type": "sphere", "material": {"emission": "$glow"}}]
})");
    const auto center = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"render", "a.json", "-o", "a.exr", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run_sahl_in(folder.path(), arguments);
        INFO(result.err);
        REQUIRE(result.status == 0);
        CHECK(image_spec(folder / "a.exr").get_string_attribute("Sahl:Camera") ==
              json_lines(result.out).at(0).at("camera").get<std::string>());
        return read_image(folder / "a.exr").pixels.at(3 * 40);
    };
    CHECK(center({}) == 0);
    CHECK(center({"--set", "glow=0.5"}) == 0.5F);
    CHECK(center({"--set", "glow=0.5", "--camera", "front"}) == 0.5F);
    CHECK(center({"--set", "glow=0.5", "--camera", "back"}) == 0);
    const ProcessResult result = run_sahl_in(folder.path(), {"render", "a.json", "--camera", "top"});
    CHECK(result.status == 2);
    CHECK(contains(result.err, "it has front, back"));
    const ProcessResult unknown = run_sahl_in(folder.path(), {"render", "a.json", "--set", "glw=1"});
    CHECK(unknown.status == 2);
    CHECK(contains(unknown.err, "did you mean 'glow'?"));
}

TEST_CASE("outputs: parameters and folders of scenes", "[cli]") {
    check_refused({"--set", "radius"}, {"--set 'radius': NAME=VALUE"});
    check_refused({"--set", "=1"}, {"NAME=VALUE"});
    check_refused({"--set", "a=1", "--set", "a=2"}, {"each name once"});
}

}  // namespace
}  // namespace sahl::tests
