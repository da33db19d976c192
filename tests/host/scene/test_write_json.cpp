// Scenes written as Sahl JSON are the same scene when they are read: what was read from other
// formats, and made-up scenes with every feature and random numbers.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/error.h"
#include "engine/scene/load.h"
#include "engine/scene/write_cse167.h"
#include "engine/scene/write_json.h"
#include "engine/scene/write_nff.h"
#include "engine/scene/write_scene.h"
#include "tests/host/scene/parse.h"
#include "tests/host/scene/resolved_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

Scene through_json(const Scene& scene) {
    const TemporaryFolder folder;
    write_scene(folder / "scene.json", scene);
    return load_scene(folder / "scene.json");
}

// The lines where the two differ first, or nothing.
std::string first_difference(const Scene& a, const Scene& b) {
    const std::string text_a = resolved(a);
    const std::string text_b = resolved(b);
    if (text_a == text_b) return "";
    std::size_t i = 0;
    while (i < text_a.size() && i < text_b.size() && text_a[i] == text_b[i]) ++i;
    const std::size_t start = i == 0 ? 0 : text_a.rfind('\n', i - 1) + 1;
    return text_a.substr(start, 300) + "\n--- against ---\n" + text_b.substr(start, 300);
}

// Random numbers of all bits, in ranges that a scene may have.
class Numbers {
public:
    explicit Numbers(unsigned seed) : random_(seed) {}

    bool coin() { return (random_() & 1U) != 0; }
    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    double size() { return std::exp(real(-10, 10)); }
    glm::dvec3 vector() { return {real(-9, 9), coin() ? 0 : real(-9, 9), real(-9, 9)}; }
    glm::dvec3 unit() { return glm::normalize(vector()); }
    glm::vec3 color() {
        return coin() ? glm::vec3(static_cast<float>(real(0, 2))) : glm::vec3(glm::abs(vector()));
    }

private:
    std::mt19937 random_;
};

Material random_material(Numbers& numbers, Scene& scene, std::string name) {
    Material m;
    m.name = std::move(name);
    const auto channel = [&](glm::vec3& color, std::uint32_t& texture) {
        color = numbers.color();
        if (numbers.below(4) > 0) return;
        color = glm::vec3(1);
        texture = static_cast<std::uint32_t>(scene.textures.size());
        Texture t;
        t.pattern = numbers.coin() ? Pattern::checker : Pattern::gradient;
        t.space = numbers.coin() ? TextureSpace::position : TextureSpace::uv;
        t.colors[0] = numbers.color();
        t.colors[1] = numbers.color();
        t.origin = numbers.vector();
        // As a loader makes it.
        t.extent = t.pattern == Pattern::checker
                       ? glm::dvec3(numbers.size(), numbers.coin() ? 0 : numbers.size(), numbers.size())
                       : numbers.vector() * numbers.size() - t.origin;
        if (t.space == TextureSpace::uv) t.extent.z = 0;
        if (t.space == TextureSpace::uv && t.pattern == Pattern::gradient) t.origin.z = 0;
        scene.textures.push_back(t);
    };
    channel(m.ambient, m.textures.ambient);
    channel(m.diffuse, m.textures.diffuse);
    channel(m.specular, m.textures.specular);
    channel(m.emission, m.textures.emission);
    channel(m.reflection, m.textures.reflection);
    m.transmission = numbers.color();
    m.shininess = static_cast<float>(numbers.size());
    m.ior = static_cast<float>(numbers.size());
    m.ior_outside = static_cast<float>(numbers.size());
    m.specular_model = numbers.coin() ? SpecularModel::phong : SpecularModel::blinn;
    m.two_sided = numbers.coin();
    if (numbers.coin()) m.reflection_attenuation = glm::vec3(1, numbers.size(), 0.1);
    return m;
}

std::uint32_t random_transform(Numbers& numbers, Scene& scene) {
    if (numbers.coin()) return 0;
    glm::dmat4 m(1);
    for (int column = 0; column < 4; ++column) m[column] += glm::dvec4(numbers.vector() / 20.0, 0);
    scene.transforms.push_back(m);
    return static_cast<std::uint32_t>(scene.transforms.size() - 1);
}

void add_primitive(Numbers& numbers, Scene& scene) {
    Primitive p;
    p.material = numbers.below(static_cast<std::uint32_t>(scene.materials.size()));
    p.transform = random_transform(numbers, scene);
    p.sides = static_cast<Sides>(numbers.below(3));
    p.kind = static_cast<PrimitiveKind>(numbers.below(6));
    const auto put = [&](auto& list, const auto& shape) {
        p.index = static_cast<std::uint32_t>(list.size());
        list.push_back(shape);
    };
    const double radius = numbers.size();
    switch (p.kind) {
        case PrimitiveKind::triangle: {
            Triangle triangle;
            triangle.smooth = numbers.coin();
            triangle.has_uv = numbers.coin();
            for (int k = 0; k < 3; ++k) {
                triangle.vertices[k] = static_cast<std::uint32_t>(scene.vertices.size());
                scene.vertices.emplace_back(numbers.vector());
                if (triangle.smooth) {
                    triangle.normals[k] = static_cast<std::uint32_t>(scene.normals.size());
                    scene.normals.emplace_back(numbers.vector());
                }
                if (triangle.has_uv) {
                    triangle.uvs[k] = static_cast<std::uint32_t>(scene.uvs.size());
                    scene.uvs.emplace_back(numbers.real(-2, 2), numbers.real(-2, 2));
                }
            }
            put(scene.triangles, triangle);
            break;
        }
        case PrimitiveKind::polygon: {
            const std::uint32_t count = 4 + numbers.below(30);
            put(scene.polygons, Polygon{static_cast<std::uint32_t>(scene.polygon_vertices.size()), count});
            for (std::uint32_t i = 0; i < count; ++i) {
                const double angle = 6.283 * i / count;
                scene.polygon_vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                                    0.125);
            }
            break;
        }
        case PrimitiveKind::sphere:
            put(scene.spheres, Sphere{numbers.vector(), radius});
            break;
        case PrimitiveKind::cone:
            put(scene.cones, Cone{numbers.vector(), numbers.vector() + glm::dvec3(0, 0, 50), radius,
                                  numbers.coin() ? radius : 0, numbers.coin()});
            break;
        case PrimitiveKind::disc:
            put(scene.discs, Disc{numbers.vector(), numbers.unit(), radius});
            break;
        case PrimitiveKind::box: {
            const glm::dvec3 lo = numbers.vector();
            put(scene.boxes, Box{lo, lo + glm::dvec3(radius, 1, numbers.size())});
            break;
        }
    }
    scene.primitives.push_back(p);
}

Scene random_scene(unsigned seed) {
    Numbers numbers(seed);
    Scene scene;
    scene.cameras[0] = {numbers.vector(), numbers.vector(), numbers.unit(), numbers.real(1, 179), "first"};
    scene.cameras.push_back({numbers.vector(), numbers.vector(), numbers.unit(), 45, "second \"view\""});
    scene.resolution = {1 + static_cast<int>(numbers.below(999)), 7};
    scene.depth = static_cast<int>(numbers.below(65));
    scene.background = numbers.color();
    if (numbers.coin()) scene.ambient = numbers.color();
    for (int i = 0; i < 5; ++i) {
        Light light;
        light.kind = static_cast<LightKind>(numbers.below(3));
        light.position = numbers.vector();
        light.color = numbers.color();
        if (light.kind != LightKind::directional && numbers.coin())
            light.attenuation = {0.1, numbers.size(), numbers.size()};
        light.direction = numbers.unit();
        light.outer_angle = numbers.real(1, 180);
        light.inner_angle = numbers.coin() ? light.outer_angle : numbers.real(0, 1);
        scene.lights.push_back(light);
    }
    for (int i = 0; i < 6; ++i)
        scene.materials.push_back(random_material(numbers, scene, "number " + std::to_string(i)));
    for (int i = 0; i < 40; ++i) add_primitive(numbers, scene);
    for (int g = 0; g < 3; ++g) {
        Group group{"group " + std::to_string(g),
                    static_cast<std::uint32_t>(scene.primitives.size()),
                    numbers.below(4),
                    {}};
        for (std::uint32_t i = 0; i < group.primitive_count; ++i) add_primitive(numbers, scene);
        for (int i = 0; i < g; ++i)
            group.instances.push_back(
                {numbers.below(static_cast<std::uint32_t>(g)), random_transform(numbers, scene)});
        scene.groups.push_back(group);
    }
    for (int i = 0; i < 4; ++i)
        scene.instances.push_back({numbers.below(3), random_transform(numbers, scene)});
    return scene;
}

}  // namespace

TEST_CASE("NFF and .test scenes are the same through JSON, and back in their own format", "[scene][write]") {
    const std::string name =
        GENERATE(as<std::string>(), "all_entities.nff", "cli_mirrors.nff", "all_commands.test");
    const Scene scene = load_scene(own_scene(name));
    const Scene read = through_json(scene);
    CHECK(first_difference(scene, read) == "");
    const Scene back = name.ends_with(".nff") ? parse_nff(write_nff(read)) : parse_cse167(write_cse167(read));
    CHECK(first_difference(scene, back) == "");
}

TEST_CASE("Reference scenes are the same through JSON, and back in their own format",
          "[scene][write][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    int count = 0;
    for (const char* folder : {"spd/nff", "cse167/scenes"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*data / folder)) {
            const std::filesystem::path extension = entry.path().extension();
            if (extension != ".nff" && extension != ".test") continue;
            INFO(entry.path().string());
            const Scene scene = load_scene(entry.path());
            const Scene read = through_json(scene);
            CHECK(first_difference(scene, read) == "");
            const Scene back =
                extension == ".nff" ? parse_nff(write_nff(read)) : parse_cse167(write_cse167(read));
            CHECK(first_difference(scene, back) == "");
            ++count;
        }
    }
    CHECK(count > 12);
}

TEST_CASE("Made-up scenes with everything are the same through JSON", "[scene][write]") {
    for (unsigned seed = 0; seed < 100; ++seed) {
        INFO("seed " << seed);
        const Scene scene = random_scene(seed);
        std::string difference;
        REQUIRE_NOTHROW(difference = first_difference(scene, through_json(scene)));
        REQUIRE(difference == "");
    }
}

TEST_CASE("JSON text is laid out for people", "[scene][write]") {
    CHECK(
        write_json(parse_nff("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 64 48\n"
                             "l 1 2 3 1 .5 .25\nf 1 1 1 .5 0 1 0 1\ns 0 .1 0 -2\np 3 0 0 0 1 0 0 0 1 0\n")) ==
        R"({
  "sahl": 1,
  "film": {"width": 64, "height": 48},
  "depth": 4,
  "background": 0,
  "cameras": {
    "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov": 45}
  },
  "lights": [
    {"type": "point", "position": [1, 2, 3], "color": [1, 0.5, 0.25]}
  ],
  "materials": {
    "fill1": {"diffuse": 0.5}
  },
  "objects": [
    {"type": "sphere", "center": [0, 0.1, 0], "radius": 2, "material": "fill1", "sides": "back"},
    {
      "type": "mesh",
      "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
      "triangles": [[0, 1, 2]],
      "material": "fill1"
    }
  ]
}
)");
}

TEST_CASE("Triangles in a row are one mesh that shares its corners", "[scene][write]") {
    const Scene read =
        through_json(parse_cse167(
            cse167_head + "vertexnormal 0 0 0 0 0 1\nvertexnormal 1 0 0 0 0 1\nvertexnormal 0 1 0 0 0 1\n"
                          "vertexnormal 1 1 0 0 0 1\nvertexnormal 0 0 0 1 0 0\n"
                          "trinormal 0 1 2\ntrinormal 1 3 2\ntrinormal 4 1 2\n"));
    CHECK(read.triangles.size() == 3);
    CHECK(read.vertices.size() == 5);  // the origin twice, with two normals
}

TEST_CASE("A flattened triangle has its corners where the transform puts them", "[scene][write]") {
    const Scene scene =
        parse_cse167(cse167_head + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 5\nscale 2 2 0\ntri 0 1 2\n");
    const Scene read = through_json(scene);
    REQUIRE(read.triangles.size() == 1);
    CHECK(read.primitives[0].transform == 0);
    CHECK(read.vertices[read.triangles[0].vertices[2]] == glm::vec3(0, 2, 0));
}

TEST_CASE("Names that JSON could not tell apart are made so", "[scene][write]") {
    Scene scene = parse_nff(nff_view);
    for (const char* name : {"red", "", "red", "$red", "material2"})
        scene.materials.emplace_back().name = name;
    const Scene read = through_json(scene);
    REQUIRE(read.materials.size() == 5);
    CHECK(read.materials[0].name == "red");
    CHECK(read.materials[1].name == "material2");
    CHECK(read.materials[2].name == "red-2");
    CHECK(read.materials[3].name == "red-3");
    CHECK(read.materials[4].name == "material2-2");
}

TEST_CASE("What JSON does not hold is refused", "[scene][write]") {
    Scene scene = parse_cse167("size 4 4\nmaxdepth 65\ncamera 0 0 5 0 0 0 0 1 0 45\n");
    CHECK_THROWS_WITH(write_json(scene),
                      "the scene's depth is 65, and a Sahl scene (.json) has 64 at most; "
                      "lower it in the scene that is read");
    scene.depth = 64;
    CHECK_NOTHROW(write_json(scene));
    scene.textures.emplace_back();
    Material& material = scene.materials.emplace_back();
    material.name = "red";
    material.diffuse = {1, 0, 0};
    material.textures.diffuse = 0;
    CHECK_THROWS_WITH(write_json(scene), Catch::StartsWith("material 'red': its diffuse is a texture times"));
    Light spot;
    spot.kind = LightKind::spot;
    spot.direction = {0, 0, 2};
    scene.materials.clear();
    scene.lights.push_back(spot);
    CHECK_THROWS_WITH(write_json(scene), Catch::StartsWith("the direction 0 0 2 has the length 2"));
}

}  // namespace sahl::tests
