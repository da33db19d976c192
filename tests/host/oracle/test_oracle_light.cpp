// The oracle's lights, textures, indices and attenuated mirrors against closed forms.
#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"
#include "engine/oracle/shading.h"

namespace sahl::oracle {
namespace {

using glm::dvec3;

bool same(const dvec3& a, const dvec3& b) { return glm::distance(a, b) < 1e-6; }

dvec3 color(const Scene& scene, const Ray& ray, int depth = 0) {
    dvec3 total(0);
    for (const dvec3& part : Oracle(scene).trace(ray, depth).radiance) total += part;
    return total;
}

Ray down_at(double x, double y) { return {{x, y, 1}, {0, 0, -1}}; }

TEST_CASE("oracle: ambient light shines on the ambient colour alone", "[oracle]") {
    Scene scene;
    scene.ambient = {0.5F, 2, 0};
    Material material = emitting({1, 2, 3});
    material.ambient = {0.5F, 0.25F, 1};
    add_square(scene, 0, 1, material);
    CHECK(same(color(scene, down_at(0, 0)), {1.25, 2.5, 3}));
}

TEST_CASE("oracle: a spot fades between its angles", "[oracle]") {
    Scene scene;
    add_square(scene, 0, 100, matte(glm::vec3(1)));
    scene.lights = {spot_light({0, 0, 10}, {0, 0, -3}, 20, 40)};
    const auto lit = [&](double degrees) {
        const double angle = glm::radians(degrees);
        return color(scene, down_at(10 * std::tan(angle), 0)).x / std::cos(angle);
    };
    CHECK(lit(0) == Approx(1));
    CHECK(lit(19.9) == Approx(1));
    CHECK(lit(40.1) == 0);
    const double middle = (std::cos(glm::radians(20.0)) + std::cos(glm::radians(40.0))) / 2;
    CHECK(lit(glm::degrees(std::acos(middle))) == Approx(0.5));
    CHECK(lit(39.9) < 1e-3);
    scene.lights = {spot_light({0, 0, 10}, {0, 0, -1}, 30, 30)};
    CHECK(lit(29.99) == Approx(1));
    CHECK(lit(30.01) == 0);
    scene.lights[0].attenuation = {0, 0, 1};
    CHECK(color(scene, down_at(0, 0)).x == Approx(0.01));
    // Beyond a right angle: a spot that leaves out only what is behind it.
    scene.lights = {spot_light({0, 0, 10}, {0, 0, 1}, 170, 179)};
    CHECK(lit(20) == Approx(1));
    CHECK(lit(0) == 0);
}

TEST_CASE("oracle: checkers and gradients by place and by surface", "[oracle]") {
    Scene scene;
    Texture texture;
    texture.colors[0] = {1, 0, 0};
    texture.colors[1] = {0, 1, 0.5F};
    texture.origin = {0.5, 0, 0};
    texture.extent = {2, 1, 0};
    Material material = emitting({0.5F, 1, 1});
    material.textures.emission = add_texture(scene, texture);
    add_square(scene, 0, 10, material);
    const dvec3 even(0.5, 0, 0), odd(0, 1, 0.5);
    CHECK(same(color(scene, down_at(1, 0.5)), even));
    CHECK(same(color(scene, down_at(3, 0.5)), odd));
    CHECK(same(color(scene, down_at(0.4, 0.5)), odd));
    CHECK(same(color(scene, down_at(0.4, -0.5)), even));
    scene.textures[0].space = TextureSpace::uv;  // from the corner (-10, -10)
    CHECK(same(color(scene, down_at(-9, -9.5)), even));
    CHECK(same(color(scene, down_at(-9.6, -9.5)), odd));
    scene.textures[0] = {
        Pattern::gradient, TextureSpace::position, {{0, 0, 0}, {1, 1, 2}}, {1, 0, 5}, {2, 0, 0}};
    CHECK(same(color(scene, down_at(0.9, 3)), {0, 0, 0}));
    CHECK(same(color(scene, down_at(1.5, 3)), {0.125, 0.25, 0.5}));
    CHECK(same(color(scene, down_at(3.5, -3)), {0.5, 1, 2}));
}

TEST_CASE("oracle: every textured term has its own texture", "[oracle]") {
    Scene scene;
    scene.background = glm::vec3(1);
    scene.lights = {directional_light({0, 0, 1})};
    const auto constant = [&](float value) {
        return add_texture(scene, {Pattern::checker,
                                   TextureSpace::position,
                                   {glm::vec3(value), glm::vec3(value)},
                                   dvec3(0),
                                   dvec3(1)});
    };
    Material material;
    material.ambient = material.diffuse = material.specular = material.emission = material.reflection =
        glm::vec3(1);
    material.textures = {constant(1), constant(10), constant(100), constant(1000), constant(10000)};
    add_square(scene, 0, 1, material);
    CHECK(color(scene, down_at(0.3, 0.3), 1).x == Approx(11111));
    const Oracle oracle(scene);
    const auto hit = oracle.closest_hit(down_at(0.3, 0.3));
    CHECK(colors_at(scene, *hit).diffuse.x == Approx(10));
}

TEST_CASE("oracle: the outside index counts as well as the inside one", "[oracle]") {
    // Up from below the surface z = 0: out of 1.5 into 1.2 until the critical angle of 53.13 degrees.
    Scene scene;
    Material material = glass(glm::vec3(1), 1.5F);
    material.ior_outside = 1.2F;
    add_square(scene, 0, 10, material);
    for (const double degrees : {53.0, 53.3}) {
        const double angle = glm::radians(degrees);
        Scene here = scene;
        add_square(here, 1, 100, emitting(glm::vec3(1)));
        CHECK(color(here, {{0, 0, -1}, {std::sin(angle), 0, std::cos(angle)}}, 1).x ==
              (degrees < 53.13 ? 1 : 0));
    }
    // Down into it: 40 degrees become asin(0.8 sin 40°).
    const double angle = glm::radians(40.0), inside = std::asin(0.8 * std::sin(angle));
    const auto spot = static_cast<float>(std::tan(angle) + std::tan(inside));
    add_polygon(
        scene, {{spot - 1e-4F, -1, -1}, {spot + 1e-4F, -1, -1}, {spot + 1e-4F, 1, -1}, {spot - 1e-4F, 1, -1}},
        emitting(glm::vec3(1)));
    CHECK(color(scene, {{0, 0, 1}, {std::sin(angle), 0, -std::cos(angle)}}, 1).x == 1);
}

TEST_CASE("oracle: mirrors weaken what comes from afar", "[oracle]") {
    Scene scene;
    scene.background = glm::vec3(8);
    Material material = mirror(glm::vec3(0.5F));
    material.reflection_attenuation = {1, 2, 3};
    add_square(scene, 0, 10, material);
    CHECK(color(scene, down_at(0, 0), 1).x == 0);  // from infinity
    add_square(scene, 4, 10, emitting(glm::vec3(1)));
    scene.primitives.back().sides = Sides::back;
    CHECK(color(scene, down_at(0, 0), 1).x == Approx(0.5 / (1 + 2 * 4 + 3 * 16)));
    const double slant = 4 / std::cos(glm::radians(30.0));
    const Ray ray{{0, 0, 1}, {std::tan(glm::radians(30.0)), 0, -1}};
    CHECK(color(scene, ray, 1).x == Approx(0.5 / (1 + 2 * slant + 3 * slant * slant)));
    scene.materials[0].reflection_attenuation = {4, 0, 0};
    CHECK(color(scene, down_at(0, 0), 1).x == Approx(0.125));
    scene.primitives.pop_back();
    CHECK(color(scene, down_at(0, 0), 1).x == Approx(1));
}

TEST_CASE("oracle: attenuation holds for all that comes back, and for total reflection", "[oracle]") {
    Scene scene;  // two mirrors at distance 1
    Material material = mirror(glm::vec3(0.5F));
    material.emission = glm::vec3(1);
    material.reflection_attenuation = {0, 4, 0};
    add_square(scene, 0, 10, material);
    add_square(scene, 1, 10, material);
    const PathRecord record = Oracle(scene).trace({{0, 0, 0.5}, {0, 0, -1}}, 4);
    for (int generation = 0; generation <= 4; ++generation)
        CHECK(record.radiance[static_cast<std::size_t>(generation)].x == Approx(std::pow(0.125, generation)));

    Scene water;
    Material surface = glass(glm::vec3(0.5F), 1.5F);
    surface.reflection = glm::vec3(0.25F);
    surface.reflection_attenuation = {0, 1, 0};
    add_square(water, 0, 10, surface);
    add_square(water, -1, 10, emitting(glm::vec3(1)));
    water.background = glm::vec3(1);
    const double angle = glm::radians(60.0);  // total, 2 back down to z = -1
    const Ray up{{0, 0, -0.5}, {std::sin(angle), 0, std::cos(angle)}};
    CHECK(color(water, up, 1).x == Approx(0.75 / 2));
    const Ray straight{{0, 0, -0.5}, {0, 0, 1}};  // the transmitted part is not weakened
    CHECK(color(water, straight, 1).x == Approx(0.5 + 0.25));
}

}  // namespace
}  // namespace sahl::oracle
