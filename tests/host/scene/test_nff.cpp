#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "engine/scene/load.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {

TEST_CASE("NFF: every entity", "[scene]") {
    const Scene scene = load_scene(own_scene("all_entities.nff"));
    CHECK(scene.background == glm::vec3(0.1F, 0.2F, 0.3F));
    CHECK(scene.cameras[0].eye == glm::dvec3(0, -5, 2));
    CHECK(scene.cameras[0].look_at == glm::dvec3(0, 0, 0.5));
    CHECK(scene.cameras[0].up == glm::dvec3(0, 0, 1));
    CHECK(scene.cameras[0].fov_y == 45);
    CHECK(scene.resolution.width == 64);
    CHECK(scene.resolution.height == 48);
    CHECK(scene.depth == 4);
    CHECK(scene.transforms.size() == 1);

    REQUIRE(scene.lights.size() == 2);
    CHECK(scene.lights[0].kind == LightKind::point);
    CHECK(scene.lights[0].position == glm::dvec3(4, -3, 5));
    CHECK(scene.lights[0].color == glm::vec3(1 / std::sqrt(2.0F)));  // of two lights
    CHECK(scene.lights[0].attenuation == glm::vec3(1, 0, 0));
    CHECK(scene.lights[1].color == glm::vec3(0.5F, 0.25F, 1));

    REQUIRE(scene.materials.size() == 2);
    const Material& opaque = scene.materials[0];
    CHECK(opaque.diffuse == glm::vec3(1.0F * 0.8F, 0.5F * 0.8F, 0.25F * 0.8F));
    CHECK(opaque.specular == glm::vec3(0.2F));
    CHECK(opaque.reflection == glm::vec3(0.2F));
    CHECK(opaque.transmission == glm::vec3(0));
    CHECK(opaque.shininess == 30);
    CHECK(opaque.ior == 1);
    CHECK(opaque.ambient == glm::vec3(0));
    CHECK(opaque.emission == glm::vec3(0));
    CHECK(opaque.specular_model == SpecularModel::phong);
    CHECK(opaque.two_sided);
    CHECK(scene.materials[1].transmission == glm::vec3(0.9F));
    CHECK(scene.materials[1].ior == 1.5F);

    // In file order: sphere, sphere, cone, triangle, polygon, patch, and a patch of two.
    REQUIRE(scene.primitives.size() == 8);
    const PrimitiveKind kinds[] = {PrimitiveKind::sphere,   PrimitiveKind::sphere,  PrimitiveKind::cone,
                                   PrimitiveKind::triangle, PrimitiveKind::polygon, PrimitiveKind::triangle,
                                   PrimitiveKind::triangle, PrimitiveKind::triangle};
    for (std::size_t i = 0; i < 8; ++i) {
        CHECK(scene.primitives[i].kind == kinds[i]);
        CHECK(scene.primitives[i].material == (i < 4 ? 0 : 1));
        CHECK(scene.primitives[i].transform == 0);
    }
    CHECK(scene.primitives[1].index == 1);
    CHECK(scene.primitives[7].index == 3);

    REQUIRE(scene.spheres.size() == 2);
    CHECK(scene.spheres[0].center == glm::dvec3(0, 0, 0.5));
    CHECK(scene.spheres[0].radius == 0.5);
    CHECK(scene.primitives[0].sides == Sides::both);
    CHECK(scene.spheres[1].radius == 20);
    CHECK(scene.primitives[1].sides == Sides::back);

    REQUIRE(scene.cones.size() == 1);
    CHECK(scene.cones[0].base == glm::dvec3(1, 0, 0));
    CHECK(scene.cones[0].base_radius == 0.3);
    CHECK(scene.cones[0].apex == glm::dvec3(1, 0, 1));
    CHECK(scene.cones[0].apex_radius == 0.1);
    CHECK(scene.primitives[2].sides == Sides::both);

    REQUIRE(scene.polygons.size() == 1);
    CHECK(scene.polygons[0].first_vertex == 0);
    CHECK(scene.polygons[0].vertex_count == 5);
    REQUIRE(scene.polygon_vertices.size() == 5);
    CHECK(scene.polygon_vertices[3] == glm::vec3(0, 1, 0.25F));

    REQUIRE(scene.triangles.size() == 4);
    CHECK_FALSE(scene.triangles[0].smooth);
    CHECK(scene.vertices[scene.triangles[0].vertices[1]] == glm::vec3(2, -2, 0));
    const Triangle& patch = scene.triangles[1];
    CHECK(patch.smooth);
    CHECK(scene.vertices[patch.vertices[2]] == glm::vec3(-1.5F, 0, 1));
    // Normals have unit length, whatever the file says.
    CHECK(scene.normals[patch.normals[0]] == glm::vec3(0, -1, 0));
    CHECK(scene.normals[patch.normals[2]] == glm::vec3(0, -1, 0));
    CHECK(scene.vertices[scene.triangles[2].vertices[0]] == glm::vec3(2, 0, 0));
    CHECK(scene.normals[scene.triangles[2].normals[1]] == glm::vec3(0, 1, 0));
    CHECK(scene.vertices[scene.triangles[3].vertices[1]] == glm::vec3(2, 0, 1));
}

TEST_CASE("NFF: lights without a colour share 1 by the root of all lights", "[scene]") {
    const std::string fill_and_sphere = "f 1 1 1 1 0 0 0 1 s 0 0 0 1\n";
    // Lights after an object count, too.
    const Scene scene =
        parse_nff(nff_view + "l 1 0 0\nl 2 0 0 .1 .2 .3\n" + fill_and_sphere + "l 3 0 0\nl 4 0 0 # last");
    REQUIRE(scene.lights.size() == 4);
    CHECK(scene.lights[0].color == glm::vec3(0.5F));
    CHECK(scene.lights[1].color == glm::vec3(0.1F, 0.2F, 0.3F));
    CHECK(scene.lights[2].color == glm::vec3(0.5F));
    CHECK(scene.lights[3].position == glm::dvec3(4, 0, 0));
    CHECK(parse_nff(nff_view + "l 1 2 3").lights[0].color == glm::vec3(1));
}

TEST_CASE("NFF: layout, order and defaults", "[scene]") {
    const Scene scene = parse_nff(
        "v resolution 3 5 hither 0\nangle\n30 up 0 0 2 at\n\n1 2 3 #c\n from +1e0 -.5\t0\n"
        "f 1 1 1 1 0 0 0 1 s 0 0 0 1 s 1 1 1\n\n2 b 0 0 1");
    CHECK(scene.resolution.width == 3);
    CHECK(scene.resolution.height == 5);
    CHECK(scene.cameras[0].eye == glm::dvec3(1, -0.5, 0));
    CHECK(scene.cameras[0].fov_y == 30);
    CHECK(scene.spheres.size() == 2);
    CHECK(scene.background == glm::vec3(0, 0, 1));
    CHECK(parse_nff(nff_view).background == glm::vec3(0));
    CHECK(parse_nff(nff_view).primitives.empty());
}

TEST_CASE("NFF: the index of refraction of an opaque fill may be 0", "[scene]") {
    const Scene scene = parse_nff(nff_view + "f 1 1 1 .5 .5 100000 0 0\nf 1 1 1 0 0 0 1 2.4");
    CHECK(scene.materials[0].ior == 1);
    CHECK(scene.materials[0].shininess == 100000);
    CHECK(scene.materials[1].ior == 2.4F);
    CHECK_THROWS_WITH(parse_nff(nff_view + "f 1 1 1 1 0 0 .5 0"), Catch::StartsWith("scene.nff:8:18: "));
}

TEST_CASE("NFF: cones and cylinders", "[scene]") {
    const auto cone = [](const std::string& text) {
        return parse_nff(nff_view + "f 1 1 1 1 0 0 0 1\n" + text).cones.at(0);
    };
    const auto sides = [](const std::string& text) {
        return parse_nff(nff_view + "f 1 1 1 1 0 0 0 1\n" + text).primitives.at(0).sides;
    };
    CHECK(cone("c 0 0 0 2 0 0 5 2").apex_radius == 2);
    CHECK(cone("c 0 0 0 2 0 0 5 0").apex_radius == 0);
    CHECK(cone("c 0 0 0 0 0 0 5 2").base_radius == 0);
    CHECK(sides("c 0 0 0 2 0 0 5 0") == Sides::both);
    CHECK(sides("c 0 0 0 -2 0 0 5 -1") == Sides::back);
    CHECK(cone("c 0 0 0 -2 0 0 5 -1").base_radius == 2);
    CHECK(sides("c 0 0 0 -2 0 0 5 0") == Sides::back);
    for (const std::string bad : {"c 0 0 0 2 0 0 5 -1", "c 0 0 0 -2 0 0 5 1", "c 0 0 0 0 0 0 5 0",
                                  "c 1 2 3 1 1 2 3 2", "c 0 0 0 1e-20 0 0 5 1"}) {
        INFO(bad);
        CHECK_THROWS_AS(cone(bad), SceneError);
    }
}

TEST_CASE("NFF: polygons and patches without area are left out", "[scene]") {
    const std::string fill = nff_view + "f 1 1 1 1 0 0 0 1\n";
    const Scene scene = parse_nff(fill +
                                  "p 3 0 0 0 1 1 1 2 2 2\n"
                                  "p 4 0 0 0 1 1 1 2 2 2 3 3 3\n"
                                  "pp 3 0 0 0 0 0 1 0 0 0 0 0 1 1 0 0 0 0 1\n"
                                  "pp 4 0 0 0 0 0 1 1 0 0 0 0 1 2 0 0 0 0 1 3 0 0 0 0 1\n"
                                  "p 3 0 0 0 1 0 0 0 1 0\n");
    REQUIRE(scene.primitives.size() == 1);
    CHECK(scene.primitives[0].kind == PrimitiveKind::triangle);
    CHECK(scene.polygons.empty());
    // One corner twice: a triangle remains.
    CHECK(parse_nff(fill + "pp 4 0 0 0 0 0 1 1 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1").triangles.size() == 1);
    CHECK(parse_nff(fill + "p 4 0 0 0 1 0 0 1 0 0 0 1 0").polygons.size() == 1);
}

TEST_CASE("NFF: a concave patch becomes triangles that cover it", "[scene]") {
    const Scene scene = parse_nff(nff_view + "f 1 1 1 1 0 0 0 1\n" +
                                  "pp 5 -1 1 0 0 0 1  1 1 0 0 0 1  0 1.5 0 0 0 1  1 3 0 0 0 1  -1 3 0 0 0 1");
    CHECK(scene.triangles.size() == 3);
    CHECK(scene.vertices.size() == 5);
    double area = 0;
    for (const Triangle& t : scene.triangles) {
        const glm::vec3 a = scene.vertices[t.vertices[0]];
        const glm::vec3 b = scene.vertices[t.vertices[1]] - a;
        const glm::vec3 c = scene.vertices[t.vertices[2]] - a;
        area += 0.5 * static_cast<double>(b.x * c.y - b.y * c.x);
    }
    CHECK(area == 3);
}

}  // namespace sahl::tests
