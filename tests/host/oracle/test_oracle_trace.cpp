// The oracle's light transport against closed forms.
#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/support/oracle_render.h"

namespace sahl::oracle {
namespace {

using glm::dvec3;

bool equal_directions(const dvec3& a, const dvec3& b, double tolerance = 1e-6) {
    return glm::distance(a, b) < tolerance;
}

dvec3 sum(const PathRecord& record) {
    dvec3 total(0);
    for (const dvec3& part : record.radiance) total += part;
    return total;
}

dvec3 color_at_depth(const Scene& scene, const Ray& ray, int depth) {
    return sum(Oracle(scene).trace(ray, depth));
}

TEST_CASE("oracle: diffuse light falls off by cosine and attenuation", "[oracle]") {
    Scene scene;
    add_square(scene, 0, 10, matte({0.5F, 0.25F, 1}));
    scene.lights = {point_light({3, 0, 4}, glm::vec3(2), {1, 0.5F, 0.25F})};
    const dvec3 color = color_at_depth(scene, {{0, 0, 1}, {0, 0, -1}}, 0);
    CHECK(equal_directions(color, 2 * 0.8 / (1 + 0.5 * 5 + 0.25 * 25) * dvec3(0.5, 0.25, 1)));
}

TEST_CASE("oracle: highlights by Phong and Blinn", "[oracle]") {
    Scene scene;
    Material material;
    material.specular = glm::vec3(1);
    material.shininess = 10;
    add_square(scene, 0, 10, material);
    scene.lights = {directional_light({1, 0, 1})};
    const Ray ray{{0, 0, 1}, {0, 0, -1}};
    CHECK(color_at_depth(scene, ray, 0).x == Approx(std::pow(std::cos(glm::radians(45.0)), 10)));
    scene.materials[0].specular_model = SpecularModel::blinn;
    CHECK(color_at_depth(scene, ray, 0).x == Approx(std::pow(std::cos(glm::radians(22.5)), 10)));
    // Light from behind the surface: Phong has no highlight there, Blinn may.
    scene.lights = {directional_light({1, 0, -0.1})};
    CHECK(color_at_depth(scene, ray, 0).x > 0);
    scene.materials[0].specular_model = SpecularModel::phong;
    CHECK(color_at_depth(scene, ray, 0) == dvec3(0));
}

TEST_CASE("oracle: facing mirrors make a geometric series", "[oracle]") {
    Scene scene;
    Material material = mirror(glm::vec3(0.5F));
    material.emission = glm::vec3(1);
    add_square(scene, 0, 10, material);
    add_square(scene, 1, 10, material);
    const PathRecord record = Oracle(scene).trace({{0, 0, 0.5}, {0.1, 0, -1}}, 6);
    double expected = 1;
    for (std::size_t generation = 0; generation <= 6; ++generation, expected /= 2) {
        CHECK(record.radiance[generation].x == Approx(expected));
        CHECK(record.counts[generation].rays == 1);
    }
}

TEST_CASE("oracle: a slab displaces a ray by Snell's law", "[oracle]") {
    const double angle = glm::radians(40.0);
    const double inside = std::asin(std::sin(angle) / 1.5);
    const double x = std::tan(angle) + 2 * std::tan(inside) + std::tan(angle);  // 1 + 2 thick + 1
    Scene scene;
    add_square(scene, 2, 10, glass(glm::vec3(0.9F), 1.5F));  // front up: enters
    // The lower side turned over, so that the ray leaves there.
    add_polygon(scene, {{-10, -10, 0}, {-10, 10, 0}, {10, 10, 0}, {10, -10, 0}},
                glass(glm::vec3(0.9F), 1.5F));
    const auto spot = static_cast<float>(x);
    add_polygon(
        scene, {{spot - 1e-4F, -1, -1}, {spot + 1e-4F, -1, -1}, {spot + 1e-4F, 1, -1}, {spot - 1e-4F, 1, -1}},
        emitting(glm::vec3(1)));
    CHECK(color_at_depth(scene, {{0, 0, 3}, {std::sin(angle), 0, -std::cos(angle)}}, 2).x == Approx(0.81));
    CHECK(color_at_depth(scene, {{0, 0, 3}, {std::sin(angle), 0, -std::cos(angle)}}, 1).x == 0);
}

TEST_CASE("oracle: total reflection adds kt to the mirrored ray", "[oracle]") {
    Scene scene;
    Material material = glass(glm::vec3(0.5F), 1.5F);
    material.reflection = glm::vec3(0.25F);
    add_square(scene, 0, 10, material);
    scene.background = glm::vec3(1);
    for (const double degrees : {41.0, 42.5}) {  // critical angle 41.81
        const double angle = glm::radians(degrees);
        const PathRecord record = Oracle(scene).trace({{0, 0, -1}, {std::sin(angle), 0, std::cos(angle)}}, 1);
        CHECK(sum(record).x == Approx(0.75));
        CHECK(record.counts[1].rays == (degrees < 41.81 ? 2 : 1));
    }
}

TEST_CASE("oracle: transparent things in the way take their factor once a surface", "[oracle]") {
    Scene scene;
    add_square(scene, 0, 10, matte(glm::vec3(1)));
    scene.lights = {point_light({0, 0, 5})};
    const Ray ray{{4, 0, 5}, {-4, 0, -5}};
    CHECK(color_at_depth(scene, ray, 0).x == Approx(1));
    add_square(scene, 2, 1, glass({0.5F, 0.25F, 1}, 1.5F));
    CHECK(equal_directions(color_at_depth(scene, ray, 0), {0.5, 0.25, 1}));
    add_sphere(scene, {{0, 0, 3.5}, 0.5}, glass(glm::vec3(0.5F), 1.5F));
    CHECK(equal_directions(color_at_depth(scene, ray, 0), {0.125, 0.0625, 0.25}));
    add_square(scene, 6, 1, matte(glm::vec3(1)));  // behind the light
    CHECK(color_at_depth(scene, ray, 0).x == Approx(0.125));
    add_square(scene, 4.5F, 1, matte(glm::vec3(1)));
    CHECK(color_at_depth(scene, ray, 0) == dvec3(0));
}

TEST_CASE("oracle: camera rays run from edge to edge of the image", "[oracle]") {
    const Camera camera{{1, 2, 3}, {1, 2, -7}, {0, 1, 0}, 60};
    const Resolution resolution{200, 100};
    CHECK(equal_directions(camera_ray(camera, resolution, 100, 50).direction, {0, 0, -1}));
    const double half = std::tan(glm::radians(30.0));
    CHECK(equal_directions(camera_ray(camera, resolution, 100, 0).direction,
                           glm::normalize(dvec3(0, half, -1))));
    CHECK(equal_directions(camera_ray(camera, resolution, 200, 50).direction,
                           glm::normalize(dvec3(2 * half, 0, -1))));
}

TEST_CASE("oracle: pixels near an edge are found", "[oracle]") {
    Scene scene;  // the half plane x < 0; its edge runs between two columns, or through one's centres
    scene.cameras[0] = {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 90};
    add_polygon(scene, {{-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0}}, emitting(glm::vec3(1)));
    CHECK(render(Oracle(scene), {16, 16}, 0, EdgeSearch::on).near_edge_count == 0);
    const Rendering odd = render(Oracle(scene), {15, 15}, 0, EdgeSearch::on);
    CHECK(odd.near_edge_count == 15);
    CHECK(odd.generations[0].rays == 225);
    CHECK(odd.pixels[0] == dvec3(1));
    CHECK(odd.pixels[14] == dvec3(0));
}

}  // namespace
}  // namespace sahl::oracle
