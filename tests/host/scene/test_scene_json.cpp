// Every feature of the Sahl scene format by its closed form.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "engine/scene/load.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

glm::dvec3 transformed(const glm::dmat4& m, glm::dvec3 p) { return m * glm::dvec4(p, 1); }

bool near(glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) < 1e-12; }

}  // namespace

TEST_CASE("A Sahl scene: film, cameras, lights", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    CHECK(scene.resolution.width == 64);
    CHECK(scene.resolution.height == 48);
    CHECK(scene.depth == 7);
    CHECK(scene.background == glm::vec3(0.1F, 0.2F, 0.3F));

    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].name == "main");
    CHECK(scene.cameras[0].eye == glm::dvec3(0, -5, 2));
    CHECK(scene.cameras[0].look_at == glm::dvec3(0, 0, 0.5));
    CHECK(scene.cameras[0].up == glm::dvec3(0, 0, 1));
    CHECK(scene.cameras[0].fov_y == 60);
    CHECK(scene.cameras[1].name == "side");
    CHECK(scene.cameras[1].up == glm::dvec3(0, 1, 0));
    CHECK(scene.cameras[1].fov_y == 45);

    REQUIRE(scene.lights.size() == 5);
    CHECK(scene.lights[0].kind == LightKind::point);
    CHECK(scene.lights[0].position == glm::dvec3(4, -3, 5));
    CHECK(scene.lights[0].color == glm::vec3(1, 0.5F, 0.25F));
    CHECK(scene.lights[0].attenuation == glm::vec3(1, 0.5F, 0.25F));
    CHECK(scene.lights[1].color == glm::vec3(1));
    CHECK(scene.lights[1].attenuation == glm::vec3(1, 0, 0));
    CHECK(scene.lights[2].kind == LightKind::directional);
    CHECK(scene.lights[2].position == glm::dvec3(0, -1, 1));  // towards the light
    CHECK_FALSE(std::signbit(scene.lights[2].position.x));
    CHECK(scene.lights[2].color == glm::vec3(0.5F));
    CHECK(scene.lights[3].kind == LightKind::spot);
    CHECK(scene.lights[3].position == glm::dvec3(0, 0, 4));
    CHECK(scene.lights[3].direction == glm::dvec3(0, 0, -1));
    CHECK(scene.lights[3].inner_angle == 10);
    CHECK(scene.lights[3].outer_angle == 20);
    CHECK(scene.lights[4].inner_angle == 30);
    CHECK(scene.lights[4].outer_angle == 30);
    CHECK(scene.lights[4].color == glm::vec3(1, 0, 0));
    CHECK(scene.lights[4].attenuation == glm::vec3(0, 0, 1));
    CHECK(scene.ambient == glm::vec3(0.75F, 0.25F, 0.25F));
}

TEST_CASE("A Sahl scene: materials and textures", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    // The named ones, then those that objects bring: none is there twice.
    REQUIRE(scene.materials.size() == 8);
    const std::string names[] = {"shiny", "glass", "checker", "tiles", "sky", "spare", "default", ""};
    for (std::size_t i = 0; i < 8; ++i) CHECK(scene.materials[i].name == names[i]);
    const Material& shiny = scene.materials[0];
    CHECK(shiny.specular_model == SpecularModel::blinn);
    CHECK(shiny.ambient == glm::vec3(0.1F));
    CHECK(shiny.diffuse == glm::vec3(1, 0.5F, 0.25F));
    CHECK(shiny.specular == glm::vec3(0.2F, 0.3F, 0.4F));
    CHECK(shiny.emission == glm::vec3(0, 0.1F, 0));
    CHECK(shiny.reflection == glm::vec3(0.3F));
    CHECK(shiny.transmission == glm::vec3(0));
    CHECK(shiny.shininess == 50);
    CHECK(shiny.reflection_attenuation == glm::vec3(1, 0.5F, 0));
    CHECK_FALSE(shiny.two_sided);
    const Material& glass = scene.materials[1];
    CHECK(glass.specular_model == SpecularModel::phong);
    CHECK(glass.transmission == glm::vec3(0.9F, 0.8F, 0.7F));
    CHECK(glass.ior == 1.5F);
    CHECK(glass.ior_outside == 1.25F);
    CHECK(glass.reflection_attenuation == glm::vec3(1, 0, 0));
    CHECK(glass.two_sided);
    const Material& spare = scene.materials[5];
    CHECK(spare.diffuse == glm::vec3(0));
    CHECK(spare.shininess == 1);
    CHECK(spare.ior == 1);
    CHECK(spare.textures.diffuse == no_texture);
    CHECK(scene.materials[6].diffuse == glm::vec3(0.8F));
    CHECK(scene.materials[7].diffuse == glm::vec3(0, 1, 0));

    REQUIRE(scene.textures.size() == 5);
    CHECK(scene.materials[2].diffuse == glm::vec3(1));
    CHECK(scene.materials[2].textures.diffuse == 0);
    CHECK(scene.materials[3].textures.ambient == 1);
    CHECK(scene.materials[4].textures.specular == 2);
    CHECK(scene.materials[4].textures.emission == 3);
    CHECK(scene.materials[4].textures.reflection == 4);
    const Texture& checker = scene.textures[0];
    CHECK(checker.pattern == Pattern::checker);
    CHECK(checker.space == TextureSpace::position);
    CHECK(checker.colors[0] == glm::vec3(1));
    CHECK(checker.colors[1] == glm::vec3(1, 0, 0));
    CHECK(checker.origin == glm::dvec3(0.5, 0, 0));
    CHECK(checker.extent == glm::dvec3(2));
    CHECK(scene.textures[1].space == TextureSpace::uv);
    CHECK(scene.textures[1].extent == glm::dvec3(1, 0.5, 0));
    CHECK(scene.textures[2].space == TextureSpace::uv);
    CHECK(scene.textures[2].extent == glm::dvec3(1, 0, 0));
    const Texture& gradient = scene.textures[3];
    CHECK(gradient.pattern == Pattern::gradient);
    CHECK(gradient.colors[0] == glm::vec3(0.5F));
    CHECK(gradient.origin == glm::dvec3(0, 0, -1));
    CHECK(gradient.extent == glm::dvec3(0, 0, 3));
    CHECK(scene.textures[4].extent == glm::dvec3(1));
}

TEST_CASE("A Sahl scene: objects in the world", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    constexpr auto triangle = PrimitiveKind::triangle;
    constexpr auto sphere = PrimitiveKind::sphere;
    constexpr auto cone = PrimitiveKind::cone;
    struct Expected {
        PrimitiveKind kind;
        std::uint32_t material;
        Sides sides = Sides::both;
    };
    const Expected expected[] = {{sphere, 0},
                                 {sphere, 6},
                                 {PrimitiveKind::box, 1, Sides::back},
                                 {PrimitiveKind::disc, 6, Sides::front},
                                 {cone, 6},
                                 {cone, 6},
                                 {cone, 6},
                                 {PrimitiveKind::polygon, 3},
                                 {triangle, 6},
                                 {triangle, 7},
                                 {triangle, 7},
                                 {triangle, 2},
                                 {sphere, 4, Sides::front},
                                 {sphere, 1, Sides::both},
                                 {sphere, 6},
                                 {sphere, 6}};
    REQUIRE(world_primitive_count(scene) == std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        INFO(i);
        CHECK(scene.primitives[i].kind == expected[i].kind);
        CHECK(scene.primitives[i].material == expected[i].material);
        CHECK(scene.primitives[i].sides == expected[i].sides);
        if (i < 12) CHECK(scene.primitives[i].transform == 0);
    }
    const auto index = [&](std::size_t i) { return scene.primitives[i].index; };
    CHECK(scene.spheres[index(0)].center == glm::dvec3(0, 0, 0.5));
    CHECK(scene.spheres[index(0)].radius == 0.5);
    CHECK(scene.spheres[index(1)].center == glm::dvec3(0));
    CHECK(scene.spheres[index(1)].radius == 1);
    CHECK(scene.boxes[index(2)].lo == glm::dvec3(-1, -2, -3));
    CHECK(scene.boxes[index(2)].hi == glm::dvec3(1, 2, 3));
    CHECK(scene.discs[index(3)].center == glm::dvec3(0, 0, 1));
    CHECK(scene.discs[index(3)].normal == glm::dvec3(0, 0, 1));
    CHECK(scene.discs[index(3)].radius == 3);
    const Cone& cylinder = scene.cones[index(4)];
    CHECK(cylinder.base == glm::dvec3(0));
    CHECK(cylinder.apex == glm::dvec3(0, 0, 1));
    CHECK(cylinder.base_radius == 1);
    CHECK(cylinder.apex_radius == 1);
    CHECK_FALSE(cylinder.capped);
    const Cone& pointed = scene.cones[index(5)];
    CHECK(pointed.base_radius == 1);
    CHECK(pointed.apex_radius == 0);
    CHECK(pointed.capped);
    CHECK(scene.cones[index(6)].base_radius == 2);
    CHECK(scene.cones[index(6)].apex_radius == 0.5);
    CHECK_FALSE(scene.cones[index(6)].capped);
    CHECK(scene.polygons[index(7)].vertex_count == 5);
    CHECK(scene.polygon_vertices[scene.polygons[index(7)].first_vertex + 3] == glm::vec3(1, 0.5F, 0));
}

TEST_CASE("A Sahl scene: polygons of three vertices and meshes", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    const auto triangle_of = [&](std::size_t i) { return scene.triangles[scene.primitives[i].index]; };
    // A polygon's (u, v) runs along its first edge and to the left, in units of length.
    const Triangle polygon = triangle_of(8);
    CHECK(polygon.has_uv);
    CHECK_FALSE(polygon.smooth);
    CHECK(scene.vertices[polygon.vertices[2]] == glm::vec3(1, 3, 0));
    CHECK(scene.uvs[polygon.uvs[0]] == glm::vec2(0, 0));
    CHECK(scene.uvs[polygon.uvs[1]] == glm::vec2(2, 0));
    CHECK(scene.uvs[polygon.uvs[2]] == glm::vec2(1, 3));

    const Triangle second = triangle_of(10);
    CHECK(second.smooth);
    CHECK(second.has_uv);
    CHECK(scene.vertices[second.vertices[1]] == glm::vec3(1, 1, 0));
    CHECK(scene.normals[second.normals[0]] == glm::vec3(0, 0, 1));
    CHECK(scene.normals[second.normals[1]] == glm::vec3(0, 0.5F, 1));
    CHECK(scene.normals[second.normals[2]] == glm::vec3(0, 0, 2));
    CHECK(scene.uvs[second.uvs[2]] == glm::vec2(0, 1));

    const Triangle plain = triangle_of(11);
    CHECK_FALSE(plain.smooth);
    CHECK_FALSE(plain.has_uv);
    CHECK(scene.vertices[plain.vertices[0]] == glm::vec3(1, 1, 0));
    // The triangle of one vertex three times was left out.
    CHECK(scene.triangles.size() == 4);
}

TEST_CASE("A Sahl scene: transforms", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    const auto matrix = [&](std::size_t i) { return scene.transforms[scene.primitives[i].transform]; };
    // Scaled, turned by 90° about z, then moved by the group.
    CHECK(near(transformed(matrix(12), {1, 0, 0}), {1, 3, 3}));
    CHECK(near(transformed(matrix(12), {0, 1, 0}), {-1, 2, 3}));
    CHECK(near(transformed(matrix(12), {0, 0, 1}), {1, 2, 6}));
    CHECK(transformed(matrix(13), {0, 0, 0}) == glm::dvec3(1, 2, 3));
    // A matrix as it was written, rows.
    const glm::dmat4 written(glm::dvec4(1, 0, 0.5, 0), glm::dvec4(2, 1, 0, 0), glm::dvec4(0, 0, 1, 0),
                             glm::dvec4(4, 5, 6, 1));
    CHECK(matrix(14) == written);
    // look_at: the origin at `from`, +z towards the point, +y near up.
    CHECK(transformed(matrix(15), {0, 0, 0}) == glm::dvec3(1, 0, 0));
    CHECK(near(transformed(matrix(15), {0, 0, 5}), {1, 0, 5}));
    CHECK(near(transformed(matrix(15), {0, 1, 0}), {1, 1, 0}));
    CHECK(near(transformed(matrix(15), {1, 0, 0}), {2, 0, 0}));
    const Scene tilted = parse_json(
        R"({"type": "sphere", "transform": {"look_at": [3, 1, 0], "from": [0, 1, 0], "up": [0, 3, 3]}})");
    CHECK(near(transformed(tilted.transforms[1], {0, 0, 1}), {1, 1, 0}));
    CHECK(near(transformed(tilted.transforms[1], {0, 1, 0}), {0, 1 + std::sqrt(0.5), std::sqrt(0.5)}));
}

TEST_CASE("A single matrix reaches the scene to the bit", "[scene][json]") {
    const Scene scene = parse_json(
        R"({"type": "sphere", "radius": 100, "transform": {"matrix": [[0.1, -0.0, 1e-300, 1.1],
            [0, 0.30000000000000004, 0, 123456789.12345679], [0, 0, 0.7, 5e-324], [0, 0, 0, 1]]}},
           {"type": "sphere", "radius": 100, "transform": {"matrix": [[0.1, 0.0, 1e-300, 1.1],
            [0, 0.30000000000000004, 0, 123456789.12345679], [0, 0, 0.7, 5e-324], [0, 0, 0, 1]]}},
           {"type": "sphere", "transform": {"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})");
    REQUIRE(scene.transforms.size() == 3);
    const glm::dmat4& m = scene.transforms[1];
    CHECK(m[0][0] == 0.1);
    CHECK(std::signbit(m[1][0]));
    CHECK(m[2][0] == 1e-300);
    CHECK(m[1][1] == 0.30000000000000004);
    CHECK(m[3][1] == 123456789.12345679);
    CHECK(m[3][2] == 5e-324);
    CHECK_FALSE(std::signbit(scene.transforms[2][1][0]));
    CHECK(scene.primitives[2].transform == 0);
}

TEST_CASE("A Sahl scene: groups and instances", "[scene][json]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    REQUIRE(scene.groups.size() == 2);
    CHECK(scene.groups[0].name == "pair");
    CHECK(scene.groups[0].first_primitive == 16);
    CHECK(scene.groups[0].primitive_count == 1);
    REQUIRE(scene.groups[0].instances.size() == 1);
    CHECK(scene.groups[0].instances[0].group == 1);
    CHECK(transformed(scene.transforms[scene.groups[0].instances[0].transform], {0, 0, 0}) ==
          glm::dvec3(1, 0, 0));
    CHECK(scene.groups[1].name == "post");
    CHECK(scene.groups[1].first_primitive == 17);
    CHECK(scene.groups[1].primitive_count == 1);
    CHECK(scene.groups[1].instances.empty());
    REQUIRE(scene.primitives.size() == 18);
    CHECK(scene.spheres[scene.primitives[16].index].radius == 0.25);
    CHECK(scene.cones[scene.primitives[17].index].base_radius == 0.1);
    CHECK(scene.primitives[17].material == 0);

    REQUIRE(scene.instances.size() == 2);
    CHECK(scene.instances[0].group == 0);
    CHECK(transformed(scene.transforms[scene.instances[0].transform], {1, 1, 1}) == glm::dvec3(3, 4, 5));
    CHECK(scene.instances[1].group == 0);
    CHECK(scene.instances[1].transform == 0);
}

TEST_CASE("The least Sahl scene has the defaults", "[scene][json]") {
    const Scene scene = parse_json("");
    CHECK(scene.resolution.width == 512);
    CHECK(scene.resolution.height == 512);
    CHECK(scene.depth == 5);
    CHECK(scene.background == glm::vec3(0));
    CHECK(scene.ambient == glm::vec3(1));
    CHECK(scene.materials.empty());
    CHECK(scene.primitives.empty());
    CHECK(scene.groups.empty());
    CHECK(scene.transforms.size() == 1);
}

TEST_CASE("A material named default is what objects without one have", "[scene][json]") {
    const Scene scene = read_scene_json(
        "scene.json", R"({"sahl": 1, "cameras": {"c": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}},
        "materials": {"default": {"diffuse": [1, 0, 0]}}, "objects": [{"type": "sphere"}, {"type": "sphere"}]})");
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.primitives[1].material == 0);
}

TEST_CASE("Millions of instances by nesting stay a few", "[scene][json]") {
    std::string groups = R"("g0": [{"type": "sphere"}])";
    for (int level = 1; level < 9; ++level) {
        groups += ", \"g" + std::to_string(level) + "\": [";
        for (int i = 0; i < 10; ++i) {
            groups += (i == 0 ? "" : ", ") + std::string(R"({"type": "instance", "group": "g)") +
                      std::to_string(level - 1) + "\"}";
        }
        groups += "]";
    }
    const Scene scene = read_scene_json(
        "scene.json",
        R"({"sahl": 1, "cameras": {"c": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}, "groups": {)" + groups +
            "}, \"objects\": [{\"type\": \"instance\", \"group\": \"g8\"}]}");
    CHECK(scene.groups.size() == 9);
    CHECK(scene.groups[8].instances.size() == 10);
}

TEST_CASE("A Sahl scene with Windows line ends and a byte order mark is the same", "[scene][json]") {
    const Scene scene =
        read_scene_json("scene.json",
                        "\xef\xbb\xbf{\"sahl\": 1,\r\n\"cameras\": {\"c\": {\"eye\": [0, 0, 5],\r\n"
                        "\"look_at\": [0, 0, 0]}}}\r\n");
    CHECK(scene.cameras[0].eye == glm::dvec3(0, 0, 5));
}

}  // namespace sahl::tests
