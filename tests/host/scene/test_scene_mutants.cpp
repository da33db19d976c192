// Mutants of scene files load, or end in an error with its place; they never do anything else.
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/host/scene/parse.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The file need not be there, what it includes is.
Scene parse(const fs::path& path, const std::string& text) {
    if (path.extension() == ".json") return read_scene_json(path, text);
    TextReader reader(path.string(), text);
    return path.extension() == ".nff" ? read_nff(reader) : read_cse167(reader);
}

class Mutator {
public:
    explicit Mutator(unsigned seed) : random_(seed) {}

    // One to three changes.
    std::string mutate(std::string text) {
        for (std::size_t changes = 1 + below(3); changes > 0 && !text.empty(); --changes) change(text);
        return text;
    }

private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

    void change(std::string& text) {
        const std::size_t at = below(text.size());
        const std::size_t length = std::min(below(60) + 1, text.size() - at);
        switch (below(12)) {
            case 0:
                text[at] = static_cast<char>(random_());
                break;
            case 1:
                text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << below(8)));
                break;
            case 2:
                text.erase(at, length);
                break;
            case 3:
                text.insert(at, text.substr(at, length));
                break;
            case 4:
                text.insert(below(text.size()), text.substr(at, length));
                break;
            case 5:
                text.resize(at);
                break;
            case 6:
                swap_words(text, at);
                break;
            case 7:
                text.insert(at, words[below(std::size(words))]);
                break;
            default:  // most often: the text stays JSON
                replace_number(text, at);
        }
    }

    void replace_number(std::string& text, std::size_t at) {
        const std::size_t start = text.find_first_of("0123456789", at);
        if (start == std::string::npos) return;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", start), text.size());
        text.replace(start, end - start, numbers[below(std::size(numbers))]);
    }

    // Two quoted words change places: keys, names, types, references.
    void swap_words(std::string& text, std::size_t at) {
        const auto word = [&](std::size_t from) {
            const std::size_t start = text.find('"', from);
            const std::size_t end = start == std::string::npos ? start : text.find('"', start + 1);
            return end == std::string::npos ? std::string() : text.substr(start, end + 1 - start);
        };
        const std::string first = word(at);
        const std::string second = word(below(text.size()));
        if (first.empty() || second.empty()) return;
        const std::size_t place = text.find(first, at);
        text.replace(place, first.size(), second);
        const std::size_t other = text.find(second, (place + second.size()) % text.size());
        if (other != std::string::npos) text.replace(other, second.size(), first);
    }

    static constexpr const char* numbers[] = {"0",
                                              "-1",
                                              "1e308",
                                              "1e999",
                                              "nan",
                                              "-0",
                                              "1e-308",
                                              "1e-20",
                                              "1e15",
                                              "-1e15",
                                              "99999999999999999999",
                                              "4294967296",
                                              "2147483647",
                                              "65536",
                                              "1.5"};
    static constexpr const char* words[] = {"{",           "}",           "[",
                                            "]",           ",",           ":",
                                            "\"",          "\\",          "//",
                                            "/*",          "*/",          "null",
                                            "true",        "\"$radius\"", "\"$x\"",
                                            " nan ",       "\n",          "\r",
                                            " -1 ",        " 1e308 ",     "[[[[",
                                            "\"\\ud800\"", "\xff",        "#",
                                            "\"a.nff\"",   "\"..\"",      "popTransform\n",
                                            " pp "};
    std::mt19937 random_;
};

bool finite(const Scene& scene) {
    const auto all = [](const auto& list) {
        return std::all_of(list.begin(), list.end(),
                           [](const auto& v) { return std::isfinite(v.x + v.y + v.z); });
    };
    bool good = all(scene.vertices) && all(scene.normals) && all(scene.polygon_vertices);
    for (const glm::dmat4& m : scene.transforms) {
        for (int i = 0; i < 4; ++i) good = good && std::isfinite(m[i].x + m[i].y + m[i].z);
    }
    for (const Camera& c : scene.cameras) {
        for (const glm::dvec3& v : {c.eye, c.look_at, c.up}) good = good && std::isfinite(v.x + v.y + v.z);
    }
    for (const Light& light : scene.lights) {
        good = good && std::isfinite(light.position.x + light.position.y + light.position.z);
        good = good && std::isfinite(light.direction.x + light.direction.y + light.direction.z);
    }
    return good;
}

// Whether every index of the scene names something.
bool consistent(const Scene& scene) {
    bool good = !scene.cameras.empty();
    const auto check = [&](bool holds) { good = good && holds; };
    for (const Primitive& p : scene.primitives) {
        const std::size_t sizes[] = {scene.triangles.size(), scene.polygons.size(), scene.spheres.size(),
                                     scene.cones.size(),     scene.discs.size(),    scene.boxes.size()};
        check(p.index < sizes[static_cast<std::size_t>(p.kind)]);
        check(p.material < scene.materials.size() && p.transform < scene.transforms.size());
    }
    for (const Triangle& t : scene.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            check(t.vertices[i] < scene.vertices.size());
            check(!t.smooth || t.normals[i] < scene.normals.size());
            check(!t.has_uv || t.uvs[i] < scene.uvs.size());
        }
    }
    for (const Polygon& p : scene.polygons) {
        check(p.vertex_count >= 4 && p.first_vertex + p.vertex_count <= scene.polygon_vertices.size());
    }
    for (const Material& m : scene.materials) {
        for (const std::uint32_t t : {m.textures.ambient, m.textures.diffuse, m.textures.specular,
                                      m.textures.emission, m.textures.reflection})
            check(t == no_texture || t < scene.textures.size());
    }
    const auto check_instances = [&](const std::vector<Instance>& instances) {
        for (const Instance& i : instances)
            check(i.group < scene.groups.size() && i.transform < scene.transforms.size());
    };
    check_instances(scene.instances);
    std::size_t next = world_primitive_count(scene);
    for (const Group& g : scene.groups) {
        check(g.first_primitive == next);
        next += g.primitive_count;
        check_instances(g.instances);
    }
    check(next == scene.primitives.size());
    return good;
}

// "/folder/file.json:12:3: …", the file being one of the folder.
bool has_place(const std::string& message, const fs::path& folder) {
    const std::string start = folder.string() + "/";
    if (!message.starts_with(start)) return false;
    const std::size_t colon = message.find(':', start.size());
    int line = 0;
    int column = 0;
    return colon != std::string::npos &&
           std::sscanf(message.c_str() + colon, ":%d:%d: ", &line, &column) == 2 && line >= 1 && column >= 1;
}

}  // namespace

TEST_CASE("10,000 mutants of scenes load or end in an error with its place", "[scene][json]") {
    const TemporaryFolder folder;
    // What including scenes refer to, unharmed.
    for (const char* name : {"all_entities.nff", "all_commands.test", "all_features.json"})
        fs::copy_file(own_scene(name), folder / name);

    struct Source {
        const char* name;
        int mutants;
    };
    Mutator mutator(20240229);
    int loaded = 0;
    int refused = 0;
    for (const auto& [name, mutants] :
         {Source{"all_features.json", 5000}, Source{"all_includes.json", 2500},
          Source{"all_entities.nff", 1250}, Source{"all_commands.test", 1250}}) {
        const std::string text = read(own_scene(name));
        REQUIRE(text.size() > 100);
        for (int round = 0; round < mutants; ++round) {
            const std::string mutant = mutator.mutate(text);
            const fs::path path = folder / ("mutant" + fs::path(name).extension().string());
            const auto start = std::chrono::steady_clock::now();
            try {
                const Scene scene = parse(path, mutant);
                ++loaded;
                if (!finite(scene) || !consistent(scene)) {
                    INFO(mutant);
                    FAIL("a scene that is not finite and consistent");
                }
            } catch (const Error& error) {
                ++refused;
                if (error.code() != ExitCode::scene || !has_place(error.what(), folder.path())) {
                    INFO(mutant);
                    INFO(error.what());
                    FAIL("an error without its place");
                }
            }
            // Milliseconds, in fact; a loaded machine with sanitizers is slower.
            if (std::chrono::steady_clock::now() - start > std::chrono::seconds(10)) {
                INFO(mutant);
                FAIL("a mutant that takes long");
            }
        }
    }
    // Most damage is seen; some, such as in comments, is none.
    CHECK(refused > 6000);
    CHECK(loaded > 500);
}

}  // namespace sahl::tests
