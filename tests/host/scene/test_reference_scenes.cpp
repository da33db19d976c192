// Scenes that others wrote: they load, and hold what a count of their words says.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/scene/load.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

// How often a word starts a line.
std::map<std::string, std::size_t> first_words(const fs::path& path) {
    std::map<std::string, std::size_t> counts;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        if (words >> word) ++counts[word];
    }
    return counts;
}

std::vector<fs::path> scenes_in(const fs::path& folder, const std::string& extension) {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == extension) scenes.push_back(entry.path());
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

}  // namespace

TEST_CASE("The Standard Procedural Databases load whole", "[scene][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    const std::vector<fs::path> scenes = scenes_in(*data / "spd" / "nff", ".nff");
    REQUIRE(scenes.size() >= 12);
    for (const fs::path& path : scenes) {
        INFO(path.string());
        auto counts = first_words(path);
        const Scene scene = load_scene(path);
        CHECK(scene.spheres.size() == counts["s"]);
        CHECK(scene.cones.size() == counts["c"]);
        CHECK(scene.lights.size() == counts["l"]);
        CHECK(scene.materials.size() == counts["f"]);
        std::size_t smooth = 0;
        for (const Triangle& triangle : scene.triangles) smooth += triangle.smooth ? 1 : 0;
        // None of them has a polygon without area or a patch of more than three corners.
        CHECK(scene.polygons.size() + scene.triangles.size() - smooth == counts["p"]);
        CHECK(smooth == counts["pp"]);
        CHECK(scene.primitives.size() == counts["s"] + counts["c"] + counts["p"] + counts["pp"]);
        CHECK(scene.depth == 4);
        if (path.filename() == "balls.nff") CHECK(scene.primitives.size() == 7382);
        if (path.filename() == "mount.nff") CHECK(scene.primitives.size() == 8196);
    }
}

TEST_CASE("The CSE 167 scenes load whole", "[scene][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    const std::vector<fs::path> scenes = scenes_in(*data / "cse167" / "scenes", ".test");
    REQUIRE(scenes.size() >= 9);
    for (const fs::path& path : scenes) {
        INFO(path.string());
        auto counts = first_words(path);
        const Scene scene = load_scene(path);
        CHECK(scene.spheres.size() == counts["sphere"]);
        CHECK(scene.triangles.size() == counts["tri"] + counts["trinormal"]);
        CHECK(scene.vertices.size() == counts["vertex"] + counts["vertexnormal"]);
        CHECK(scene.lights.size() == counts["point"] + counts["directional"]);
        CHECK(scene.resolution.width == 640);
        CHECK(scene.resolution.height == 480);
        CHECK(scene.depth == 5);
    }
}

TEST_CASE("Scenes with commands of another course are refused by the command", "[scene][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    const std::vector<fs::path> scenes = scenes_in(*data / "cse167" / "cse168" / "scenes", ".test");
    REQUIRE(scenes.size() >= 9);
    for (const fs::path& path : scenes) {
        INFO(path.string());
        CHECK_THROWS_WITH(load_scene(path), Catch::StartsWith(path.string() + ":") &&
                                                Catch::Contains("unknown command '") &&
                                                Catch::Contains("commands are size, camera"));
    }
}

}  // namespace sahl::tests
