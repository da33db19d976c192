// Damaged scenes end in a scene error with a place, or load; they never do anything else.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// One to four changes: bytes, words that loaders stumble over, pieces that go or come twice.
std::string damage(std::string text, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    static const std::string words[] = {
        "0",  "-1", "1e999", "nan", "inf", "999999999999", "1e15",   "-1e15",        "1e-300",      "pp", "p",
        "c",  "s",  "f",     "l",   "v",   "tri",          "sphere", "popTransform", "scale 0 0 0", "\n", "#",
        "\r", "3",  "-0"};
    const std::size_t changes = 1 + below(4);
    for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
        const std::size_t at = below(text.size());
        const std::size_t length = std::min(below(40) + 1, text.size() - at);
        switch (below(6)) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(at, length));
                break;
            case 3:
                text.insert(at, " " + words[below(std::size(words))] + " ");
                break;
            case 4:
                text.resize(at);
                break;
            default: {
                // A number for a number.
                const std::size_t digit = text.find_first_of("0123456789", at);
                if (digit != std::string::npos) text.replace(digit, 1, words[below(std::size(words))]);
            }
        }
    }
    return text;
}

bool finite(const Scene& scene) {
    for (const auto* list : {&scene.vertices, &scene.normals, &scene.polygon_vertices}) {
        for (const glm::vec3& v : *list) {
            if (!std::isfinite(v.x + v.y + v.z)) return false;
        }
    }
    return true;
}

// Whether every index of the scene names something.
bool consistent(const Scene& scene) {
    for (const Primitive& p : scene.primitives) {
        const std::size_t sizes[] = {scene.triangles.size(), scene.polygons.size(), scene.spheres.size(),
                                     scene.cones.size()};
        if (p.index >= sizes[static_cast<std::size_t>(p.kind)]) return false;
        if (p.material >= scene.materials.size() || p.transform >= scene.transforms.size()) return false;
    }
    for (const Triangle& t : scene.triangles) {
        for (int i = 0; i < 3; ++i) {
            if (t.vertices[i] >= scene.vertices.size()) return false;
            if (t.smooth && t.normals[i] >= scene.normals.size()) return false;
        }
    }
    for (const Polygon& p : scene.polygons) {
        if (p.vertex_count < 4 || p.first_vertex + p.vertex_count > scene.polygon_vertices.size())
            return false;
    }
    return true;
}

}  // namespace

TEST_CASE("Damaged scenes load or end in a scene error with its place", "[scene]") {
    const bool nff = GENERATE(true, false);
    const std::string text = read(own_scene(nff ? "all_entities.nff" : "all_commands.test"));
    REQUIRE(text.size() > 100);
    const std::string name = nff ? "scene.nff:" : "scene.test:";
    std::mt19937 random(2024);
    int refused = 0;
    for (int round = 0; round < 2000; ++round) {
        const std::string damaged = damage(text, random);
        try {
            const Scene scene = nff ? parse_nff(damaged) : parse_cse167(damaged);
            if (!finite(scene) || !consistent(scene)) {
                INFO(damaged);
                FAIL("a scene that is not finite and consistent");
            }
        } catch (const SceneError& error) {
            ++refused;
            int line = 0;
            int column = 0;
            const std::string message = error.what();
            const bool placed = message.starts_with(name) &&
                                std::sscanf(message.c_str() + name.size(), "%d:%d: ", &line, &column) == 2 &&
                                line >= 1 && column >= 1;
            if (!placed || error.code() != ExitCode::scene) {
                INFO(message);
                FAIL("an error without its place");
            }
        }
    }
    // Most damage is seen; some, such as in comments, is none.
    CHECK(refused > 800);
    CHECK(refused < 2000);
}

}  // namespace sahl::tests
