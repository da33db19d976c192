// `sahl batch` where nothing goes wrong: what it renders, what it does not render again, what it says.
#include <algorithm>
#include <array>
#include <fstream>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/batch_night.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

/// The reasons of all images that a run rendered.
std::vector<std::string> reasons(const ProcessResult& result) {
    std::vector<std::string> found;
    for (const nlohmann::json& event : events(result, "render")) found.push_back(event.at("reason"));
    return found;
}

}  // namespace

TEST_CASE("batch: each image is rendered as sahl render does it, and not again by a second call",
          "[cli][batch]") {
    const Night night("1-3,100");
    const ProcessResult first = night.run();
    INFO(first.err);
    REQUIRE(first.status == 0);
    CHECK(events(first, "image").size() == 4);
    const auto files = night.files();
    CHECK(files.size() == 4);
    CHECK_FALSE(fs::exists(night.folder / "out/.sahl-batch.lock"));

    const ProcessResult single =
        run_sahl_in(night.folder.path(), {"render", "balls.json", "--set", "x=2", "-o", "single.exr"});
    REQUIRE(single.status == 0);
    CHECK(read_image(night.folder / "out/0100.exr").pixels == read_image(night.folder / "single.exr").pixels);

    const ProcessResult second = night.run();
    CHECK(second.status == 0);
    CHECK(events(second, "render").empty());
    CHECK(events(second, "summary").at(0).at("finished_before") == 4);
    CHECK(night.files() == files);
}

TEST_CASE("batch: settings, cameras and names of any bytes reach the worker as they are", "[cli][batch]") {
    const Night night("1");
    const std::string scene = "sc\xc3\xa8ne \xff.json";  // a space, UTF-8, and a byte that is none
    fs::copy_file(night.folder / "balls.json", night.folder / scene);
    const std::vector<std::string> settings{"--size",          "20x12",
                                            "--depth",         "2",
                                            "--spp",           "3",
                                            "--seed",          "7000000000",
                                            "--aov",           "Z,id.primitive",
                                            "--pixel-type",    "float",
                                            "--exposure",      "0.3",
                                            "--compression",   "piz",
                                            "--build-quality", "fast",
                                            "--traversal",     "scalar",
                                            "--set",           "x=0.1",
                                            "--threads",       "1",
                                            "--max-mem",       "200M"};
    std::vector<std::string> batch{"batch", scene, "--cameras", "top", "-o", "a b/{scene}.exr"};
    std::vector<std::string> render{"render", scene, "--camera", "top", "-o", "single.exr"};
    batch.insert(batch.end(), settings.begin(), settings.end());
    render.insert(render.end(), settings.begin(), settings.end());
    const ProcessResult result = run_sahl_in(night.folder.path(), batch);
    INFO(result.err);
    REQUIRE(result.status == 0);
    const ProcessResult single = run_sahl_in(night.folder.path(), render);
    INFO(single.err);
    REQUIRE(single.status == 0);
    const fs::path image = night.folder / "a b/sc\xc3\xa8ne \xff.exr";
    CHECK(read_image(image).pixels == read_image(night.folder / "single.exr").pixels);
    // The record is longer, and nothing else: layers, types and compression are the same.
    const std::string bytes = content_of(image);
    for (const char* text : {"id.primitive", "Sahl:Record", "piz"}) CHECK(contains(bytes, text));
    batch.emplace_back("--check");
    CHECK(run_sahl_in(night.folder.path(), batch).status == 0);
}

TEST_CASE("batch: what is missing, damaged or changed is rendered again, and the reason is said",
          "[cli][batch]") {
    const Night night("1-3", R"(["out/{frame:04}.exr", "out/{frame:04}.png"])");
    REQUIRE(night.run().status == 0);
    const auto files = night.files();
    const auto unchanged = [&](std::initializer_list<const char*> but) {
        for (const auto& [name, identity] : night.files()) {
            const bool is_new = std::find(but.begin(), but.end(), name) != but.end();
            CHECK((files.at(name) == identity) != is_new);
        }
    };

    fs::remove(night.folder / "out/0002.png");
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/0002.png: it is not there"});
    unchanged({"0002.png"});  // not even the other file of the same image

    fs::resize_file(night.folder / "out/0002.exr", fs::file_size(night.folder / "out/0002.exr") - 1);
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/0002.exr: it is cut short"});
    fs::resize_file(night.folder / "out/0003.png", fs::file_size(night.folder / "out/0003.png") - 1);
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/0003.png: it is cut short"});
    write_file(night.folder / "out/0003.png", "no image");
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/0003.png: it is no image of its format"});
    write_image(night.folder / "out/0001.png", read_image(night.folder / "out/0003.png"), {});
    CHECK(reasons(night.run()) ==
          std::vector<std::string>{"out/0001.png: it has no record of where it came from"});

    night.write_scene("[0.8, 0.2, 0.5]");
    CHECK(reasons(night.run()) ==
          std::vector<std::string>{"out/0001.exr: balls.json: materials.red.diffuse changed",
                                   "out/0002.exr: balls.json: materials.red.diffuse changed",
                                   "out/0003.exr: balls.json: materials.red.diffuse changed"});
    night.write_manifest("1-3", R"("out/{frame:04}.exr")", R"({"spp": 4})");
    CHECK(reasons(night.run()).at(0) == "spp changed from 1 to 4");
    night.write_manifest("0-3", R"("out/{frame:04}.exr")", R"({"spp": 4})");
    CHECK(reasons(night.run()) == std::vector<std::string>{"it is not there"});
}

TEST_CASE("batch: comments, layout and descriptions of a scene change nothing, its includes do",
          "[cli][batch]") {
    const TemporaryFolder folder;
    const auto write_scenes = [&](const std::string& outer, const std::string& inner) {
        write_file(folder / "outer.json", outer + R"({"sahl": 1, "film": {"width": 8, "height": 8},
  "cameras": {"main": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}},
  "objects": [{"type": "include", "uri": "inner.json"}]})");
        write_file(folder / "inner.json", inner + R"({"sahl": 1, "description": ")" + inner.substr(2, 3) +
                                              R"(", "objects": [{"type": "sphere", "radius": )" +
                                              (inner.find('2') == std::string::npos ? "1" : "2") + "}]}");
    };
    const auto run = [&] {
        const ProcessResult result = run_sahl_in(folder.path(), {"batch", "outer.json", "--json"});
        INFO(result.err);
        return reasons(result);
    };
    write_scenes("", "// a b\n");
    run();
    write_scenes("/* new */\n\n", "// c d\n");
    CHECK(run().empty());
    write_scenes("", "// 2 c\n");
    CHECK(run() == std::vector<std::string>{"inner.json: objects[0].radius changed"});
}

TEST_CASE("batch: images whose format keeps no record have it in one file of their folder", "[cli][batch]") {
    const Night night("1-2", R"(["out/{frame}.jpg", "out/{frame}.tif", "out/{frame}.hdr"])");
    REQUIRE(night.run().status == 0);
    CHECK(fs::exists(night.folder / "out/.sahl-batch.json"));
    const auto files = night.files();
    CHECK(files.size() == 6);
    REQUIRE(night.run().status == 0);
    CHECK(night.files() == files);
    // Somebody was killed in the midst of a line.
    std::ofstream(night.folder / "out/.sahl-batch.json", std::ios::app) << R"({"name":"1.jpg","size":3,"rec)";
    REQUIRE(night.run().status == 0);
    CHECK(night.files() == files);
    fs::remove(night.folder / "out/2.tif");
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/2.tif: it is not there"});
    write_file(night.folder / "out/1.jpg", "short");
    CHECK(reasons(night.run()) == std::vector<std::string>{"out/1.jpg: its size is not what was written"});
    fs::remove(night.folder / "out/.sahl-batch.json");
    CHECK(reasons(night.run()).size() == 2);
}

TEST_CASE("batch: --check reports with 7 and changes nothing, --force renders all again", "[cli][batch]") {
    const Night night("1-3");
    const ProcessResult before = night.run({"--check"});
    CHECK(before.status == 7);
    CHECK(events(before, "job").size() == 3);
    CHECK_FALSE(fs::exists(night.folder / "out"));
    REQUIRE(night.run().status == 0);
    const auto files = night.files();
    const ProcessResult check = night.run({"--check"});
    CHECK(check.status == 0);
    CHECK(check.out.empty());
    CHECK(night.files() == files);
    CHECK(reasons(night.run({"--force"})) == std::vector<std::string>(3, "forced"));
    for (const auto& [name, identity] : night.files()) CHECK(identity != files.at(name));
}

TEST_CASE("batch: --dry-run lists outputs, memory and an estimate, and writes nothing", "[cli][batch]") {
    const Night night("1-10000");
    const ProcessResult result = night.run({"--dry-run"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    const std::vector<nlohmann::json> jobs = events(result, "job");
    REQUIRE(jobs.size() == 10000);
    CHECK(jobs.at(41).at("paths") == nlohmann::json({"out/0042.exr"}));
    CHECK(jobs.at(41).at("reason") == "it is not there");
    CHECK(events(result, "scene").at(0).at("memory").at("total") > 0);
    CHECK(events(result, "estimate").at(0).at("seconds") > 0);
    CHECK_FALSE(fs::exists(night.folder / "out"));
}

TEST_CASE("batch: scenes without a manifest, a camera each", "[cli][batch]") {
    const Night night("1");
    fs::copy_file(scene_file("cli_mirrors.nff"), night.folder / "mirrors.nff");
    const ProcessResult result = run_sahl_in(
        night.folder.path(),
        {"batch", "balls.json", "mirrors.nff", "-o", "img/{scene}.png", "--size", "20x10", "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    for (const char* name : {"balls", "mirrors"})
        CHECK(read_image(night.folder / "img" / (name + std::string(".png"))).width == 20);
    const ProcessResult cameras =
        run_sahl_in(night.folder.path(),
                    {"batch", "balls.json", "--cameras", "main,top", "-o", "{camera}.exr", "--set", "x=1"});
    INFO(cameras.err);
    REQUIRE(cameras.status == 0);
    CHECK(read_image(night.folder / "main.exr").pixels != read_image(night.folder / "top.exr").pixels);
    const ProcessResult unknown =
        run_sahl_in(night.folder.path(), {"batch", "balls.json", "--cameras", "mian", "-o", "{camera}.exr"});
    CHECK(unknown.status == 8);
    CHECK(contains(unknown.err, "no camera 'mian'; did you mean 'main'?; it has main, top"));
}

TEST_CASE("batch: mistakes end it before any work", "[cli][batch]") {
    const Night night("1-2", R"("same.png")");
    const ProcessResult same = night.run();
    CHECK(same.status == 3);
    CHECK(contains(same.err, "two images would go into 'same.png'"));
    night.write_manifest("1-2", R"("night.json/{frame}.png")", "{}");
    const ProcessResult folder = night.run();
    CHECK(folder.status == 6);
    night.write_manifest("1", R"("/dev/null")", "{}");
    CHECK(contains(night.run().err, "no regular file"));
    CHECK(run_sahl_in(night.folder.path(), {"batch", "balls.json", "-o", "{scen}.png"}).status == 2);
    CHECK(run_sahl_in(night.folder.path(), {"batch", "night.json", "--frames", "1"}).status == 2);
    CHECK(night.folder.entries() == 2);
}

TEST_CASE("batch: a moving camera reads and builds nothing again, a moving ball no more than it has to",
          "[cli][batch]") {
    const auto counts = [](const ProcessResult& result) {
        INFO(result.err);
        REQUIRE(result.status == 0);
        std::array<int, 3> images{};
        for (const nlohmann::json& event : events(result, "image")) {
            ++images[0];
            if (event.at("loaded")) ++images[1];
            if (event.at("built")) ++images[2];
        }
        return images;
    };
    const Night night("1-4");
    CHECK(counts(night.run()) == std::array{4, 4, 4});
    write_file(night.folder / "night.json",
               R"({"outputs": "turn/{frame}.png", "jobs": [{"scene": "balls.json",
  "frames": "1-5", "cameras": [{"name": "turn", "eye": [0, 1, 6], "look_at": [0, 0, 0],
                                "turn": {"keys": [[1, 0], [6, 360]]}}]}]})");
    CHECK(counts(night.run()) == std::array{5, 1, 1});
    CHECK(read_image(night.folder / "turn/1.png").pixels != read_image(night.folder / "turn/2.png").pixels);
    // A parameter that only the camera uses: read again, not built again.
    write_file(night.folder / "orbit.json", R"({"sahl": 1, "film": {"width": 8, "height": 8},
  "parameters": {"eye": {"type": "vector", "default": [0, 0, 5]}},
  "cameras": {"main": {"eye": "$eye", "look_at": [0, 0, 0]}}, "objects": [{"type": "sphere"}]})");
    write_file(night.folder / "night.json",
               R"({"outputs": "orbit/{frame}.png", "jobs": [{"scene": "orbit.json",
  "frames": "1-5", "parameters": {"eye": {"keys": [[1, [0, 0, 5]], [5, [4, 0, 5]]]}}}]})");
    CHECK(counts(night.run()) == std::array{5, 5, 1});
}

TEST_CASE("batch: AOVs are in the EXR file of each frame", "[cli][batch]") {
    const Night night("1-2", R"(["out/{frame}.exr", "out/{frame}.png"])", R"({"aov": ["Z", "N"]})");
    REQUIRE(night.run().status == 0);
    CHECK(contains(content_of(night.folder / "out/2.exr"), "N.X"));
    REQUIRE(
        run_sahl_in(night.folder.path(), {"render", "balls.json", "--set", "x=-2", "-o", "a.exr"}).status ==
        0);
    CHECK(read_image(night.folder / "a.exr").pixels == read_image(night.folder / "out/1.exr").pixels);
    CHECK(events(night.run(), "render").empty());
}

TEST_CASE("batch: status file, contact sheet and events", "[cli][batch]") {
    const Night night("1-3", R"(["out/{frame}.exr"])");
    const ProcessResult result = night.run({"--status", "status.json", "--export-html", "sheet.html"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    const nlohmann::json status = nlohmann::json::parse(content_of(night.folder / "status.json"));
    CHECK(status.at("state") == "done");
    CHECK(status.at("finished") == 3);
    const std::string page = content_of(night.folder / "sheet.html");
    std::size_t images = 0;
    for (std::size_t at = page.find("<img src=\"data:image/jpeg;base64,/9j/"); at != std::string::npos;
         at = page.find("<img src=\"data:image/jpeg;base64,/9j/", at + 1))
        ++images;
    CHECK(images == 3);
    CHECK_FALSE(contains(page, "http"));
    CHECK(events(result, "start").at(0).at("to_render") == 3);
    CHECK(events(result, "image").at(0).at("rays") >= 24 * 16);
    CHECK(contains(result.err, "wrote out/1.exr"));
}

TEST_CASE("batch: contributions that are not finite are counted and reported", "[cli][batch]") {
    const TemporaryFolder folder;
    write_file(folder / "bright.json", R"({"sahl": 1, "film": {"width": 4, "height": 4},
  "cameras": {"main": {"eye": [0, 0, 0], "look_at": [1, 0, 0], "up": [0, 0, 1]}},
  "objects": [{"type": "sphere", "material": {"emission": 1, "reflection": 1e15}}]})");
    const ProcessResult result = run_sahl_in(folder.path(), {"batch", "bright.json", "--json"});
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(events(result, "image").at(0).at("non_finite") > 0);
    CHECK(contains(result.err, "contributions were no finite numbers"));
}

}  // namespace sahl::tests
