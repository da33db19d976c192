#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/load.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

// Where the only sphere's centre and x-axis end go.
glm::dmat4 transform_of(const std::string& commands) {
    const Scene scene = parse_cse167(cse167_head + commands + "\nsphere 0 0 0 1\n");
    return scene.transforms.at(scene.primitives.at(0).transform);
}

void check_near(glm::dvec3 a, glm::dvec3 b) {
    INFO(a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z);
    CHECK(glm::length(a - b) < 1e-12);
}

glm::dvec3 apply(const glm::dmat4& m, glm::dvec3 p) { return glm::dvec3(m * glm::dvec4(p, 1)); }

}  // namespace

TEST_CASE("CSE 167: every command", "[scene]") {
    const Scene scene = load_scene(own_scene("all_commands.test"));
    CHECK(scene.resolution.width == 64);
    CHECK(scene.resolution.height == 48);
    CHECK(scene.depth == 3);
    CHECK(scene.cameras[0].eye == glm::dvec3(0, -5, 2));
    CHECK(scene.cameras[0].look_at == glm::dvec3(0, 0, 0.5));
    CHECK(scene.cameras[0].up == glm::dvec3(0, 0, 1));
    CHECK(scene.cameras[0].fov_y == 45);
    CHECK(scene.background == glm::vec3(0));

    REQUIRE(scene.lights.size() == 2);
    CHECK(scene.lights[0].kind == LightKind::directional);
    CHECK(scene.lights[0].position == glm::dvec3(0, -1, 1));
    CHECK(scene.lights[0].color == glm::vec3(0.5F));
    CHECK(scene.lights[0].attenuation == glm::vec3(1, 0, 0));
    CHECK(scene.lights[1].kind == LightKind::point);
    CHECK(scene.lights[1].attenuation == glm::vec3(1, 0.1F, 0.05F));

    REQUIRE(scene.primitives.size() == 5);
    CHECK(scene.primitives[0].kind == PrimitiveKind::triangle);
    CHECK(scene.primitives[2].kind == PrimitiveKind::sphere);
    CHECK(scene.primitives[3].kind == PrimitiveKind::triangle);
    CHECK(scene.primitives[3].index == 2);

    // Two materials: before and after `specular`. A pop brings no material back.
    REQUIRE(scene.materials.size() == 2);
    CHECK(scene.primitives[1].material == 0);
    CHECK(scene.primitives[2].material == 1);
    CHECK(scene.primitives[4].material == 1);
    const Material& plain = scene.materials[0];
    CHECK(plain.ambient == glm::vec3(0.1F));
    CHECK(plain.diffuse == glm::vec3(1, 0, 0));
    CHECK(plain.specular == glm::vec3(0));
    CHECK(plain.reflection == glm::vec3(0));
    CHECK(plain.emission == glm::vec3(0));
    CHECK(plain.specular_model == SpecularModel::blinn);
    CHECK_FALSE(plain.two_sided);
    const Material& shiny = scene.materials[1];
    CHECK(shiny.diffuse == glm::vec3(1, 0, 0));
    CHECK(shiny.specular == glm::vec3(0.2F, 0.3F, 0.4F));
    CHECK(shiny.reflection == glm::vec3(0.2F, 0.3F, 0.4F));
    CHECK(shiny.transmission == glm::vec3(0));
    CHECK(shiny.shininess == 50);
    CHECK(shiny.emission == glm::vec3(0, 0.1F, 0));

    // The sphere and the triangle after it share their matrix: translate · rotate · scale.
    REQUIRE(scene.transforms.size() == 2);
    CHECK(scene.primitives[0].transform == 0);
    CHECK(scene.primitives[2].transform == 1);
    CHECK(scene.primitives[3].transform == 1);
    CHECK(scene.primitives[4].transform == 0);
    check_near(apply(scene.transforms[1], {1, 0, 0}), {0, 2, 1});
    check_near(apply(scene.transforms[1], {0, 1, 0}), {-1, 0, 1});
    check_near(apply(scene.transforms[1], {0, 0, 1}), {0, 0, 1.5});

    // Vertices stay as they were written; the two lists are independent.
    CHECK(scene.vertices[scene.triangles[1].vertices[2]] == glm::vec3(-1, 1, 0));
    const Triangle& smooth = scene.triangles[2];
    CHECK(smooth.smooth);
    CHECK_FALSE(scene.triangles[0].smooth);
    CHECK(scene.vertices[smooth.vertices[1]] == glm::vec3(1, 0, 1));
    CHECK(scene.normals[smooth.normals[0]] == glm::vec3(0, 0, 1));
    CHECK(glm::length(scene.normals[smooth.normals[2]] - glm::vec3(1, 0, 1) / std::sqrt(2.0F)) < 1e-6F);
}

TEST_CASE("CSE 167: defaults", "[scene]") {
    const Scene scene = parse_cse167(cse167_head + "point 1 2 3 1 1 1\nsphere 0 0 0 1");
    CHECK(scene.depth == 5);
    CHECK(scene.materials.at(0).ambient == glm::vec3(0.2F));
    CHECK(scene.materials.at(0).diffuse == glm::vec3(0));
    CHECK(scene.materials.at(0).emission == glm::vec3(0));
    CHECK(scene.lights.at(0).attenuation == glm::vec3(1, 0, 0));
}

TEST_CASE("CSE 167: matrices multiply from the right", "[scene]") {
    check_near(apply(transform_of("translate 1 2 3\nscale 2 2 2"), {1, 1, 1}), {3, 4, 5});
    check_near(apply(transform_of("scale 2 2 2\ntranslate 1 2 3"), {1, 1, 1}), {4, 6, 8});
    // Axes need not be unit length; angles are in degrees, counter-clockwise.
    check_near(apply(transform_of("rotate 0 0 7 90"), {1, 0, 0}), {0, 1, 0});
    check_near(apply(transform_of("rotate 1 1 1 120"), {1, 0, 0}), {0, 1, 0});
    check_near(apply(transform_of("rotate 0 1 0 -90"), {1, 0, 0}), {0, 0, 1});
    check_near(apply(transform_of("scale -1 1 1"), {1, 0, 0}), {-1, 0, 0});
    CHECK(transform_of("") == glm::dmat4(1));
}

TEST_CASE("CSE 167: push copies the top and pop brings it back", "[scene]") {
    const Scene scene = parse_cse167(cse167_head +
                                     "translate 1 0 0\npushTransform\ntranslate 0 1 0\nsphere 0 0 0 1\n"
                                     "popTransform\nsphere 0 0 0 1\npushTransform\nsphere 0 0 0 1\n");
    REQUIRE(scene.primitives.size() == 3);
    const auto position = [&](std::size_t i) {
        return apply(scene.transforms[scene.primitives[i].transform], {0, 0, 0});
    };
    CHECK(position(0) == glm::dvec3(1, 1, 0));
    CHECK(position(1) == glm::dvec3(1, 0, 0));
    CHECK(position(2) == glm::dvec3(1, 0, 0));
    CHECK(scene.primitives[1].transform == scene.primitives[2].transform);
}

TEST_CASE("CSE 167: the last attenuation holds for all point lights", "[scene]") {
    const Scene scene = parse_cse167(cse167_head +
                                     "point 0 0 0 1 1 1\nattenuation 0 1 0\npoint 1 0 0 1 1 1\n"
                                     "attenuation 0 0 1\ndirectional 0 1 0 1 1 1\n");
    CHECK(scene.lights[0].attenuation == glm::vec3(0, 0, 1));
    CHECK(scene.lights[1].attenuation == glm::vec3(0, 0, 1));
    CHECK(scene.lights[2].attenuation == glm::vec3(1, 0, 0));
}

TEST_CASE("CSE 167: flattened and empty objects", "[scene]") {
    const std::string triangle = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    // A scale of 0 across a flat triangle does no harm.
    CHECK(parse_cse167(cse167_head + triangle + "scale 1 1 0\ntri 0 1 2").triangles.size() == 1);
    CHECK(parse_cse167(cse167_head + triangle + "scale 1 0 1\ntri 0 1 2").triangles.empty());
    CHECK(parse_cse167(cse167_head + triangle + "tri 0 1 1").triangles.empty());
    CHECK_THROWS_AS(parse_cse167(cse167_head + "scale 1 0 1\nsphere 0 0 0 1"), SceneError);
    CHECK_THROWS_AS(
        parse_cse167(cse167_head + "rotate 1 2 3 40\nscale 1 0 1\nrotate 1 2 3 40\nsphere 0 0 0 1"),
        SceneError);
    CHECK_THROWS_WITH(parse_cse167(cse167_head + "rotate 1 2 3 40\nscale 1e3 1e-10 1e3\nsphere 0 0 0 1"),
                      Catch::Contains("no inverse"));
    // Thin is not flat.
    CHECK(parse_cse167(cse167_head + "rotate 1 2 3 40\nscale 1 1e-6 1\nsphere 0 0 0 1").spheres.size() == 1);
    CHECK(parse_cse167(cse167_head + "scale 1e-8 1e-8 1e-8\nsphere 0 0 0 1").spheres.size() == 1);
    CHECK_THROWS_AS(parse_cse167(cse167_head + "scale 1e-8 1e-8 1e-8\nsphere 0 0 0 1e-8"), SceneError);
    CHECK_THROWS_AS(parse_cse167(cse167_head + "scale 1e8 1 1\nsphere 1e8 0 0 1"), SceneError);
}

}  // namespace sahl::tests
