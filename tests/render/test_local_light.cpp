// Local illumination in closed form: every pixel of an image against the formula.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using oracle::add_sphere;
using oracle::add_square;
using oracle::directional_light;
using oracle::point_light;

Scene seen_from(const dvec3& eye, double fov_y = 45) {
    Scene scene;
    scene.cameras[0] = {eye, {0, 0, 0}, {0, 1, 0}, fov_y};
    return scene;
}

/// Pixels whose colour is not the formula's; `expected` takes the pixel's camera ray.
template <class Expected>
int wrong_pixels(const Scene& scene, int size, const Expected& expected) {
    const RenderSettings settings = square_settings(size, 0);
    const Rendered rendered = render(scene, settings);
    int wrong = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            if (!close(rendered.at(x, y), expected(pixel_ray(scene, settings, x, y)))) ++wrong;
        }
    }
    return wrong;
}

TEST_CASE("render: an empty scene shows the background", "[render]") {
    Scene scene = seen_from({0, 0, 4});
    scene.background = {0.25F, 0.5F, 2};
    CHECK(wrong_pixels(scene, 32, [](const oracle::Ray&) { return dvec3(0.25, 0.5, 2); }) == 0);
}

TEST_CASE("render: a sphere in ambient light is a disc of one colour", "[render]") {
    Scene scene = seen_from({0, 0, 4});
    scene.background = {0, 0, 0.5F};
    Material material;
    material.ambient = {0.5F, 0.25F, 0};
    material.emission = {0.125F, 0, 0};
    add_sphere(scene, {{0, 0, 0}, 1}, material);
    int inside = 0;
    const int wrong = wrong_pixels(scene, 128, [&](const oracle::Ray& ray) {
        const bool hit = glm::length(glm::cross(ray.origin, ray.direction)) < 1;
        inside += hit ? 1 : 0;
        return hit ? dvec3(0.625, 0.25, 0) : dvec3(0, 0, 0.5);
    });
    CHECK(wrong == 0);
    CHECK(inside > 1000);
}

TEST_CASE("render: diffuse light falls off by cosine and attenuation", "[render]") {
    const auto c0 = GENERATE(0.5F, 0.0F);
    const auto c1 = GENERATE(0.25F, 0.0F);
    Scene scene = seen_from({0, 0, 5});
    add_square(scene, 0, 10, oracle::matte({0.75F, 0.5F, 0.25F}));
    scene.lights = {point_light({1, -0.5, 2}, {3, 4, 5}, {c0, c1, 0.125F})};
    const int wrong = wrong_pixels(scene, 64, [&](const oracle::Ray& ray) {
        const dvec3 to_light = dvec3(1, -0.5, 2) - meet_plane(ray, 0);
        const double d = glm::length(to_light);
        return to_light.z / d / (c0 + c1 * d + 0.125 * d * d) * dvec3(2.25, 2, 1.25);
    });
    CHECK(wrong == 0);
}

TEST_CASE("render: directional light has no distance and any length of vector", "[render]") {
    Scene scene = seen_from({0, 0, 5});
    add_square(scene, 0, 10, oracle::matte({0.5F, 0.5F, 0.5F}));
    scene.lights = {directional_light({0, 30, 40}, {1, 2, 4}), directional_light({0, 0, -1})};
    CHECK(wrong_pixels(scene, 16, [](const oracle::Ray&) { return 0.4 * dvec3(1, 2, 4); }) == 0);
}

TEST_CASE("render: highlights of Phong and Blinn", "[render]") {
    const auto model = GENERATE(SpecularModel::phong, SpecularModel::blinn);
    const auto shininess = GENERATE(1.0F, 3.0827F, 40.0F, 100000.0F);
    Scene scene = seen_from({0, 0, 3}, 80);
    Material material;
    material.specular = {1, 0.5F, 0.25F};
    material.shininess = shininess;
    material.specular_model = model;
    add_square(scene, 0, 10, material);
    scene.lights = {point_light({0.5, 1, 2}, {2, 2, 2})};
    const int wrong = wrong_pixels(scene, 64, [&](const oracle::Ray& ray) {
        const dvec3 l = glm::normalize(dvec3(0.5, 1, 2) - meet_plane(ray, 0));
        const dvec3 v = -ray.direction;
        const double cosine =
            model == SpecularModel::phong ? glm::dot(dvec3(-l.x, -l.y, l.z), v) : glm::normalize(l + v).z;
        return 2 * std::pow(std::max(cosine, 0.0), shininess) * dvec3(1, 0.5, 0.25);
    });
    // Single precision knows a cosine to 6e-8, so x^100000 to about one percent.
    CHECK(wrong <= (shininess > 1000 ? 8 : 0));
}

TEST_CASE("render: light from behind gives Phong nothing and Blinn its highlight", "[render]") {
    Scene scene = seen_from({0, 0, 3});
    Material material;
    material.diffuse = glm::vec3(1);
    material.specular = glm::vec3(1);
    material.shininess = 4;
    material.two_sided = false;
    add_square(scene, 0, 10, material);
    scene.lights = {directional_light({1, 0, -0.5})};
    SECTION("where R·V is positive") {
        scene.cameras[0] = {{-4, 0, 1.2}, {0, 0, 0}, {0, 0, 1}, 10};
        CHECK(wrong_pixels(scene, 32, [](const oracle::Ray&) { return dvec3(0); }) == 0);
        return;
    }
    scene.materials[0].specular_model = SpecularModel::blinn;
    const dvec3 l = glm::normalize(dvec3(1, 0, -0.5));
    const int wrong = wrong_pixels(scene, 32, [&](const oracle::Ray& ray) {
        return dvec3(std::pow(std::max(glm::normalize(l - ray.direction).z, 0.0), 4));
    });
    CHECK(wrong == 0);
}

TEST_CASE("render: one-sided materials keep their normal, two-sided ones turn it", "[render]") {
    const bool two_sided = GENERATE(false, true);
    Scene scene = seen_from({0, 0, -3});  // sees the back
    Material material = oracle::matte(glm::vec3(1));
    material.two_sided = two_sided;
    add_square(scene, 0, 10, material);
    scene.lights = {directional_light({0, 0, 1}, {0.5F, 0, 0}), directional_light({0, 0, -1}, {0, 0.25F, 0})};
    const dvec3 expected = two_sided ? dvec3(0, 0.25, 0) : dvec3(0.5, 0, 0);
    CHECK(wrong_pixels(scene, 16, [&](const oracle::Ray&) { return expected; }) == 0);
}

}  // namespace
}  // namespace sahl::tests
