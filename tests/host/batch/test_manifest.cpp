// Manifests: what they expand to, their errors, and their schema.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "engine/batch/expand.h"
#include "engine/batch/manifest.h"
#include "engine/core/error.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

struct Manifest {
    TemporaryFolder folder;
    fs::path path = folder / "night.json";

    explicit Manifest(const std::string& text) { std::ofstream(path) << text; }
    std::vector<BatchJob> jobs() const { return expand_batch(read_manifest(path)); }
    std::string error() const {
        try {
            jobs();
        } catch (const SceneError& error) {
            const std::string text = error.what();
            return text.substr(text.find("night.json"));
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }
    std::vector<std::string> outputs() const {
        std::vector<std::string> names;
        for (const BatchJob& job : jobs())
            for (const fs::path& output : job.outputs)
                names.push_back(output.lexically_relative(folder.path()).string());
        return names;
    }
};

using Texts = std::vector<std::string>;

/// Whether the schema takes the text.
bool schema_takes(const std::string& text) {
    std::ifstream file(fs::path(std::getenv("SAHL_SOURCE_DIR")) / "docs/sahl-batch.schema.json");
    const nlohmann::json document = nlohmann::json::parse(file);
    valijson::Schema schema;
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
    const nlohmann::json manifest = nlohmann::json::parse(text, nullptr, true, true);
    return valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(manifest), nullptr);
}

}  // namespace

TEST_CASE("batch manifest: scenes, parameters, frames and cameras multiply in that order", "[batch]") {
    const Manifest manifest(R"({
  // a night
  "outputs": "out/{scene}/{camera}_{sun}_{frame:03}.png",
  "settings": {"spp": 4, "size": [64, 48]},
  "jobs": [{"scene": ["a.json", "b.nff"], "cameras": ["front", "top"], "frames": "1-2",
            "parameters": {"sun": {"values": [0.5, 1]}}, "settings": {"spp": 9}}]
})");
    CHECK(manifest.outputs() == Texts{"out/a/front_0.5_001.png", "out/a/top_0.5_001.png",
                                      "out/a/front_0.5_002.png", "out/a/top_0.5_002.png",
                                      "out/a/front_1_001.png", "out/a/top_1_001.png", "out/a/front_1_002.png",
                                      "out/a/top_1_002.png", "out/b/front_0.5_001.png",
                                      "out/b/top_0.5_001.png", "out/b/front_0.5_002.png",
                                      "out/b/top_0.5_002.png", "out/b/front_1_001.png", "out/b/top_1_001.png",
                                      "out/b/front_1_002.png", "out/b/top_1_002.png"});
    const std::vector<BatchJob> jobs = manifest.jobs();
    CHECK(jobs[0].settings.spp == 9);
    CHECK(jobs[0].settings.size->width == 64);
    CHECK(jobs[0].scene == manifest.folder / "a.json");
    CHECK(jobs[3].parameters == decltype(jobs[3].parameters){{"sun", "0.5"}});
    CHECK(jobs[3].frame == 2);
}

TEST_CASE("batch manifest: zipped parameters change together, others multiply", "[batch]") {
    const Manifest manifest(R"({"jobs": [{
  "scene": "a.json", "outputs": "{x}{y}{z}.png", "zip": [["x", "z"]],
  "parameters": {"x": {"range": "1-2"}, "y": {"values": ["p", "q"]}, "z": {"values": ["u", "v"]}}}]})");
    CHECK(manifest.outputs() == Texts{"1pu.png", "1qu.png", "2pv.png", "2qv.png"});
}

TEST_CASE("batch manifest: values follow the frames by their keys", "[batch]") {
    const Manifest manifest(R"({"jobs": [{
  "scene": "a.json", "outputs": "{frame}.png", "frames": "0-4x2",
  "parameters": {"on": true, "tint": [1, 0.5, 0], "sun": {"keys": [[0, 1], [4, 2]]},
                 "place": {"keys": [[0, [0, 0, 0]], [4, [1, 2, 4]]], "interpolation": "linear"}}}]})");
    const std::vector<BatchJob> jobs = manifest.jobs();
    REQUIRE(jobs.size() == 3);
    CHECK(jobs[1].parameters ==
          decltype(jobs[1].parameters){
              {"on", "true"}, {"tint", "1,0.5,0"}, {"sun", "1.5"}, {"place", "0.5,1,2"}});
}

TEST_CASE("batch manifest: a camera of its own turns about what it looks at", "[batch]") {
    const Manifest manifest(R"({"jobs": [{
  "scene": "a.json", "outputs": "{camera}{frame}.png", "frames": "0-3",
  "cameras": ["main", {"name": "turn", "eye": [0, 3, 5], "look_at": [0, 1, 1], "fov": 30,
                       "turn": {"keys": [[0, 0], [4, 360]]}}]}]})");
    const std::vector<BatchJob> jobs = manifest.jobs();
    REQUIRE(jobs.size() == 8);
    CHECK_FALSE(jobs[0].view);
    const auto check_eye = [&](std::size_t job, glm::dvec3 eye) {
        REQUIRE(jobs[job].view);
        for (int axis = 0; axis < 3; ++axis)
            CHECK(jobs[job].view->eye[axis] == Approx(eye[axis]).margin(1e-12));
        CHECK(jobs[job].view->fov_y == 30);
    };
    check_eye(1, {0, 3, 5});
    check_eye(3, {4, 3, 1});  // counter-clockwise seen from above
    check_eye(5, {0, 3, -3});
}

TEST_CASE(
    "batch manifest: mistakes are errors with their places, and the schema refuses what has a wrong form",
    "[batch]") {
    const auto check = [](const std::string& job, const std::string& error, bool is_wrong_form) {
        const std::string text = "{\"jobs\": [\n" + job + "]}";
        INFO(text);
        const std::string found = Manifest(text).error();
        INFO(found);
        CHECK(found.find(error) != std::string::npos);
        CHECK(schema_takes(text) == !is_wrong_form);
    };
    const std::string start = R"({"scene": "a.json", "outputs": "a.png", )";
    check(R"({"outputs": "a.png"})", "night.json:2:1: this job has no 'scene'", true);
    check(R"({"scene": "a.obj", "outputs": "a.png"})", "night.json:2:11: no scene format", true);
    check(R"({"scene": "a.json"})", "night.json:2:1: this job has no 'outputs'", false);
    check(start + R"("frmes": 1})", "unknown key 'frmes' of a job; did you mean 'frames'?", true);
    check(start + R"("frames": "1-"})", "night.json:2:51: '1-' is no list of numbers", true);
    check(start + R"("frames": "1,1"})", "the frame 1 is there twice", false);
    check(start + R"("frames": "1-2x0.5"})", "the frame 1.5 is no whole number", false);
    check(start + R"("frames": "1-2"})", "two images would go into", false);
    check(start + R"("parameters": {"x": {"values": []}}})", "this parameter has no value", true);
    check(start + R"("parameters": {"x": [1, 2]}})", "several values are {\"values\": [...]}", true);
    check(start + R"("parameters": {"x": {"keys": [[1, 2], [1, 3]]}}, "frames": 1})",
          "the frame 1 is not behind", false);
    check(start + R"("parameters": {"x": {"keys": [[1, 2], [2, 3]]}}})", "keys follow the frames", false);
    check(start + R"("parameters": {"x": 1}, "zip": [["y"]]})", "there is no parameter 'y' here", false);
    check(start +
              R"("zip": [["x", "y"]], "parameters": {"x": {"values": [1, 2]}, "y": {"values": [1, 2, 3]}}})",
          "'y' has 3 values and 'x' has 2", false);
    check(start + R"("settings": {"spp": 0}})", "'spp' must be", true);
    check(start + R"("settings": {"size": [10]}})", "a width and a height", true);
    check(start + R"("settings": {"aov": ["Z", "Q"]}})", "unknown aov 'Q'", true);
    check(start + R"("settings": {"aov": ["Z"]}})", "has no room for AOVs", false);
    check(start + R"("settings": {"compression": "zap"}})", "there is no compression 'zap'", false);
    check(start + R"("settings": {"pixel_type": "half"}})", "pixel type half does not fit this format",
          false);
    check(start + R"("cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, 0]}]})", "night.json:2:53",
          false);
    check(R"({"scene": "a.json", "outputs": "{frame}.png"})",
          "nothing here is called {frame}; there is {scene}", false);
    check(R"({"scene": "a.json", "outputs": "a.xyz"})", "has no extension of an image format", false);
    check(R"({"scene": "a.json", "outputs": ["a.png", "b/../a.png"]})", "two images would go into", false);
    check(R"({"scene": ["a.json", "b.json"], "outputs": "a.png"})", "such as with {scene}", false);
    CHECK(Manifest("{\"jobs\": []}").error().find("there is no job") != std::string::npos);
    CHECK(Manifest("{\"jobs\": [}").error().find("night.json:1:11") != std::string::npos);
}

TEST_CASE("batch manifest: it is one by its key 'jobs', whatever its name", "[batch]") {
    const Manifest manifest(R"({"jobs": []})");
    CHECK(is_manifest(manifest.path));
    const Manifest scene(R"({"sahl": 1, "objects": [{"jobs": 1}]})");
    CHECK_FALSE(is_manifest(scene.path));
    CHECK_FALSE(is_manifest("balls.nff"));
}

TEST_CASE("batch manifest: the examples of the documentation expand, and the schema takes them", "[batch]") {
    int found = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(std::getenv("SAHL_SOURCE_DIR")) / "docs/examples/batch")) {
        if (entry.path().extension() != ".json") continue;
        ++found;
        INFO(entry.path());
        CHECK_FALSE(expand_batch(read_manifest(entry.path())).empty());
        std::ifstream file(entry.path());
        CHECK(schema_takes({std::istreambuf_iterator<char>(file), {}}));
    }
    CHECK(found > 0);
}

}  // namespace sahl::tests
