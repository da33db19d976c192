// Reflection, refraction and shadows in closed form.
#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using oracle::add_polygon;
using oracle::add_sphere;
using oracle::add_square;
using oracle::emitting;
using oracle::glass;
using oracle::mirror;

/// A square whose front is below.
void add_square_facing_down(Scene& scene, float height, float half, const Material& material) {
    add_polygon(scene,
                {{-half, -half, height}, {-half, half, height}, {half, half, height}, {half, -half, height}},
                material);
}

TEST_CASE("render: facing mirrors make a geometric series, depth by depth", "[render]") {
    Scene scene;
    scene.cameras[0] = {{0, 0, 0.5}, {0.1, 0, 0}, {0, 1, 0}, 40};
    Material material = mirror({0.5F, 0.75F, 0.25F});
    material.emission = {1, 2, 3};
    add_square(scene, 0, 100, material);
    add_square(scene, 1, 100, material);
    Renderer renderer(test_device(), scene);
    dvec3 expected(0);
    dvec3 weight(1);
    for (int depth = 0; depth <= 7; ++depth) {
        expected += weight * dvec3(1, 2, 3);
        weight *= dvec3(0.5, 0.75, 0.25);
        const Rendered rendered = render(renderer, square_settings(16, depth));
        int wrong = 0;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) wrong += close(rendered.at(x, y), expected, 1e-6) ? 0 : 1;
        }
        CHECK(wrong == 0);
        REQUIRE(rendered.statistics.generations.size() == static_cast<std::size_t>(depth) + 1);
        for (const GenerationCounts& counts : rendered.statistics.generations) {
            CHECK(counts.rays == 256);
            CHECK(counts.shadow_rays == 0);
        }
    }
}

/// The x at which a ray through the slab 0 <= z <= 1 of index 1.5 lands on z = -1.
double landing_behind_slab(const oracle::Ray& ray) {
    const dvec3 entry = meet_plane(ray, 1);
    const double sine = std::sqrt(1 - ray.direction.z * ray.direction.z);
    const double inside = std::asin(sine / 1.5);
    const double sideways = std::tan(inside) + std::tan(std::asin(sine));  // in the slab and below
    return entry.x + sideways * (sine > 0 ? ray.direction.x / sine : 0);
}

TEST_CASE("render: a slab displaces what is behind it by Snell's law", "[render]") {
    constexpr int strips = 60;
    constexpr float width = 0.1F;
    constexpr float left = -3;
    Scene scene;
    scene.cameras[0] = {{0.3, 0.2, 3}, {0.5, 0, 0}, {0, 1, 0}, 40};
    add_square(scene, 1, 10, glass(glm::vec3(0.5F), 1.5F));
    add_square_facing_down(scene, 0, 10, glass(glm::vec3(0.5F), 1.5F));
    for (int strip = 0; strip < strips; ++strip) {
        const float x0 = left + width * static_cast<float>(strip);
        const float x1 = left + width * static_cast<float>(strip + 1);
        add_polygon(scene, {{x0, -5, -1}, {x1, -5, -1}, {x1, 5, -1}, {x0, 5, -1}},
                    emitting(strip % 2 == 0 ? glm::vec3(4, 0, 0) : glm::vec3(0, 4, 0)));
    }
    const RenderSettings settings = square_settings(128, 2);
    const Rendered rendered = render(scene, settings);
    int wrong = 0;
    int compared = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const double place = (landing_behind_slab(pixel_ray(scene, settings, x, y)) - left) / width;
            REQUIRE((place > 0 && place < strips));
            if (std::abs(place - std::round(place)) < 1e-4) continue;
            ++compared;
            const bool even = static_cast<int>(place) % 2 == 0;
            if (!close(rendered.at(x, y), even ? dvec3(1, 0, 0) : dvec3(0, 1, 0), 1e-6)) ++wrong;
        }
    }
    CHECK(wrong == 0);
    CHECK(compared > 16000);
}

TEST_CASE("render: beyond the critical angle all light is reflected, as one ray", "[render]") {
    Scene scene;
    scene.background = {0, 0, 1};
    scene.cameras[0] = {{0, 0, -1}, {0.9, 0, 0}, {0, 1, 0}, 40};
    Material surface = glass(glm::vec3(0.5F), 1.5F);
    surface.reflection = glm::vec3(0.25F);
    add_square(scene, 0, 100, surface);  // front up: the camera is inside
    add_square(scene, -2, 100, emitting({1, 0, 0}));
    const RenderSettings settings = square_settings(64, 1);
    const Rendered rendered = render(scene, settings);
    const double critical = std::asin(1 / 1.5);
    int wrong = 0;
    int total = 0;
    std::uint64_t children = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const double angle = std::acos(pixel_ray(scene, settings, x, y).direction.z);
            REQUIRE(std::abs(angle - critical) > 1e-6);
            const bool all = angle > critical;
            total += all ? 1 : 0;
            children += all ? 1 : 2;
            if (!close(rendered.at(x, y), all ? dvec3(0.75, 0, 0) : dvec3(0.25, 0, 0.5), 1e-6)) ++wrong;
        }
    }
    CHECK(wrong == 0);
    CHECK(total > 500);
    CHECK(total < 3500);
    CHECK(rendered.statistics.generations.at(1).rays == children);
}

TEST_CASE("render: glass of index 1 bends nothing and filters once a surface", "[render]") {
    Scene scene;
    scene.background = {1, 1, 1};
    scene.cameras[0] = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
    add_sphere(scene, {{0, 0, 0}, 1}, glass({0.5F, 0.75F, 1}, 1));
    const Rendered rendered = render(scene, square_settings(32, 2));
    CHECK(close(rendered.at(16, 16), {0.25, 0.5625, 1}, 1e-6));
    CHECK(close(rendered.at(0, 0), {1, 1, 1}, 1e-6));
    const Rendered too_shallow = render(scene, square_settings(32, 1));
    CHECK(close(too_shallow.at(16, 16), {0, 0, 0}, 1e-6));
}

/// A lit floor seen from the side of what hangs between it and the light.
Scene shadowed_floor() {
    Scene scene;
    scene.cameras[0] = {{6, 0, 3}, {0, 0, 0}, {0, 0, 1}, 1};
    add_square(scene, 0, 10, oracle::matte(glm::vec3(1)));
    scene.lights = {oracle::point_light({0, 0, 5})};
    return scene;
}

dvec3 middle(const Scene& scene) {
    const Rendered rendered = render(scene, square_settings(9, 0));
    CHECK(rendered.statistics.generations.at(0).shadow_rays == 81);
    return rendered.at(4, 4);
}

TEST_CASE("render: shadows of transparent surfaces take the factor once a surface", "[render]") {
    Scene scene = shadowed_floor();
    const double lit = middle(scene).x;
    CHECK(lit == Approx(1).margin(1e-5));
    SECTION("a plane, once") {
        add_square(scene, 2, 1, glass({0.5F, 0.25F, 1}, 1.5F));
        CHECK(close(middle(scene), {0.5, 0.25, 1}));
    }
    SECTION("a sphere, twice, and straight on") {
        add_sphere(scene, {{0.3, 0, 2}, 0.5}, glass({0.5F, 0.25F, 1}, 1.5F));
        CHECK(close(middle(scene), {0.25, 0.0625, 1}));
    }
    SECTION("one behind the other, in whatever order they are listed") {
        const bool from_above = GENERATE(false, true);
        for (int i = 0; i < 6; ++i) {
            const float height = 1 + 0.5F * static_cast<float>(from_above ? 5 - i : i);
            add_square(scene, height, 1, glass(glm::vec3(0.5F + 0.05F * static_cast<float>(i)), 1.5F));
        }
        double expected = 1;
        for (int i = 0; i < 6; ++i) expected *= 0.5 + 0.05 * i;
        CHECK(close(middle(scene), dvec3(expected)));
    }
    SECTION("two in the same place, both") {
        add_square(scene, 2, 1, glass(glm::vec3(0.5F), 1.5F));
        add_square(scene, 2, 1, glass(glm::vec3(0.5F), 1.5F));
        CHECK(close(middle(scene), dvec3(0.25)));
    }
    SECTION("opaque between transparent ones: black") {
        add_square(scene, 1, 1, glass(glm::vec3(0.5F), 1.5F));
        add_square(scene, 2, 1, oracle::matte(glm::vec3(1)));
        add_square(scene, 3, 1, glass(glm::vec3(0.5F), 1.5F));
        CHECK(middle(scene) == dvec3(0));
    }
    SECTION("beyond the light: nothing") {
        add_square(scene, 5.5F, 3, oracle::matte(glm::vec3(1)));
        add_square(scene, 6, 3, glass(glm::vec3(0.5F), 1.5F));
        CHECK(close(middle(scene), dvec3(1)));
    }
    SECTION("directional lights are behind everything") {
        scene.lights = {oracle::directional_light({0, 0, 1})};
        add_square(scene, 1000, 100, glass(glm::vec3(0.5F), 1.5F));
        CHECK(close(middle(scene), dvec3(0.5)));
    }
}

}  // namespace
}  // namespace sahl::tests
