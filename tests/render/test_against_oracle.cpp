// The engine's images and ray counts against the double-precision oracle, on scenes with every
// primitive under every kind of affine transform.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/render/oracle_image.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

using glm::dmat4;
using glm::dvec3;
using oracle::add_cone;
using oracle::add_polygon;
using oracle::add_sphere;
using oracle::add_square;
using oracle::add_triangle;

Material glossy(const glm::vec3& color, float reflection) {
    Material material;
    material.ambient = 0.1F * color;
    material.diffuse = color;
    material.specular = glm::vec3(0.4F);
    material.shininess = 12;
    material.reflection = glm::vec3(reflection);
    return material;
}

Material tinted_glass() {
    Material material = glossy({0.05F, 0.1F, 0.1F}, 0.1F);
    material.transmission = {0.7F, 0.8F, 0.9F};
    material.ior = 1.4F;
    return material;
}

Material one_sided_blinn() {
    Material material = glossy({0.2F, 0.6F, 0.3F}, 0.2F);
    material.specular_model = SpecularModel::blinn;
    material.two_sided = false;
    return material;
}

dmat4 placed(const dvec3& position, double degrees, const dvec3& axis, const dvec3& scale) {
    return glm::scale(glm::rotate(glm::translate(dmat4(1), position), glm::radians(degrees), axis), scale);
}

dmat4 sheared(const dvec3& position, double shear) {
    dmat4 matrix = glm::translate(dmat4(1), position);
    matrix[2][0] = shear;
    return matrix;
}

Scene still_life() {
    Scene scene;
    scene.cameras[0] = {{0.3, -7, 4}, {0, 0, 0.8}, {0, 0, 1}, 40};
    scene.background = {0.1F, 0.2F, 0.4F};
    scene.lights = {oracle::point_light({4, -5, 6}, {30, 28, 25}, {1, 0.1F, 0.5F}),
                    oracle::directional_light({-2, -1, 3}, {0.4F, 0.4F, 0.5F})};
    add_square(scene, 0, 6, glossy({0.6F, 0.5F, 0.4F}, 0.25F));
    add_sphere(scene, {{-1.6, -1.2, 0.81}, 0.8}, tinted_glass());
    add_sphere(scene, {{0, 0, 0}, 1}, glossy({0.8F, 0.2F, 0.2F}, 0.3F),
               placed({1.7, 0.6, 0.9}, 30, {1, 2, 3}, {0.9, 0.5, 0.7}));
    add_sphere(scene, {{0, 0, 0}, 0.6}, one_sided_blinn(), sheared({0.2, 1.6, 0.7}, 0.5));
    add_cone(scene, {{0, 0, 0}, {0, 0, 1.4}, 0.6, 0.1}, glossy({0.2F, 0.3F, 0.8F}, 0.2F),
             placed({-2.6, 1.2, 0.05}, 20, {0, 1, 0}, {1, -0.6, 1.2}));
    add_cone(scene, {{1.2, -1.9, 0.3}, {2.6, -1.3, 0.35}, 0.25, 0.25}, glossy({0.8F, 0.7F, 0.2F}, 0));
    add_cone(scene, {{-0.2, -2.2, 0.01}, {-0.2, -2.2, 0.7}, 0.3, 0.45}, tinted_glass());
    add_polygon(scene,
                {{0, 0, 0}, {1.5F, 0, 0}, {1.5F, 0.5F, 0}, {0.5F, 0.5F, 0}, {0.5F, 1.5F, 0}, {0, 1.5F, 0}},
                glossy({0.5F, 0.2F, 0.6F}, 0.2F), placed({-0.9, 0.2, 0.3}, 75, {1, 0, 0.2}, {1, 1.2, -1}));
    add_triangle(scene, {{0, 0, 0}, {1.2F, 0, 0.1F}, {0.4F, 0.3F, 1.1F}}, glossy({0.3F, 0.7F, 0.7F}, 0.3F),
                 placed({0.9, -0.9, 0.2}, 15, {0, 0, 1}, {-1, 1, 1}),
                 {{-0.3F, -1, 0}, {0.3F, -1, 0}, {0, -1, 0.5F}});
    add_triangle(scene, {{2.8F, 2, 0.1F}, {4, 1, 0.1F}, {3.2F, 1.8F, 2}}, one_sided_blinn());
    add_sphere(scene, {{0, 2, 3}, 9}, glossy({0.3F, 0.3F, 0.3F}, 0));  // a room around it all
    scene.primitives.back().sides = Sides::back;
    return scene;
}

/// Shapes of all kinds at random, with transforms of all kinds.
Scene random_scene(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] {
        const double x = uniform(random);
        const double y = uniform(random);
        return dvec3(x, y, uniform(random));
    };
    const auto color = [&] { return glm::vec3(0.5 + 0.4 * vector()); };
    Scene scene;
    scene.cameras[0] = {{0.5, -8, 1}, {0, 0, 0}, {0.1, 0, 1}, 38};
    scene.background = color();
    scene.lights = {oracle::point_light({5, -6, 7}, {1, 1, 1}),
                    oracle::point_light({-6, -3, 2}, {0.5F, 0.4F, 0.3F})};
    for (int i = 0; i < 30; ++i) {
        const dvec3 place = 2.2 * vector();
        const dvec3 scale = 0.5 + 0.3 * vector();
        const dmat4 transform =
            placed(place, 180 * uniform(random), vector(), i % 3 == 0 ? scale * dvec3(1, 1, -1) : scale);
        Material material = i % 5 == 0 ? tinted_glass() : glossy(color(), i % 2 == 0 ? 0.3F : 0);
        if (i % 7 == 0) material = one_sided_blinn();
        switch (i % 4) {
            case 0:
                add_sphere(scene, {0.3 * vector(), 1}, material, transform);
                break;
            case 1:
                add_cone(scene, {{0, 0, -1}, {0, 0, 1}, 0.8, 0.4 + 0.4 * uniform(random)}, material,
                         transform);
                break;
            case 2:
                add_triangle(scene, {vector(), vector(), vector()}, material, transform);
                break;
            default:
                add_polygon(scene, {{-1, -1, 0}, {1, -1, 0}, {0.2F, 0, 0}, {1, 1, 0}, {-1, 0.9F, 0}},
                            material, transform);
        }
    }
    return scene;
}

TEST_CASE("render: the still life is the oracle's, pixel by pixel", "[render][oracle]") {
    const Scene scene = still_life();
    const oracle::Oracle reference(scene);
    Renderer renderer(test_device(), scene);
    for (const int depth : {0, 1, 4}) {
        const RenderSettings settings = square_settings(160, depth);
        const Rendered rendered = render(renderer, settings);
        const oracle::Rendering expected =
            oracle::render(reference, settings.resolution, depth, oracle::EdgeSearch::on);
        const Comparison comparison = compare(rendered, expected, 1e-3);
        INFO("depth " << depth << ": " << comparison.compared << " of 25600 pixels compared");
        CHECK(comparison.compared > 25600 * 8 / 10);
        CHECK(comparison.wrong == 0);
        CHECK(comparison.mean < 2e-6);
        check_counts(rendered.statistics, expected.generations, 1e-4, 2);
    }
}

TEST_CASE("render: random scenes are the oracle's, pixel by pixel", "[render][oracle]") {
    const unsigned seed = GENERATE(range(1U, 9U));
    const Scene scene = random_scene(seed);
    const RenderSettings settings = square_settings(64, 3);
    const Rendered rendered = render(scene, settings);
    const oracle::Rendering expected =
        oracle::render(oracle::Oracle(scene), settings.resolution, 3, oracle::EdgeSearch::on);
    const Comparison comparison = compare(rendered, expected, 1e-3);
    INFO("seed " << seed << ": " << comparison.compared << " of 4096 pixels compared");
    CHECK(comparison.compared > 4096 * 6 / 10);
    CHECK(comparison.wrong == 0);
    CHECK(comparison.mean < 5e-6);
    check_counts(rendered.statistics, expected.generations, 1e-4, 2);
}

TEST_CASE("render: ray counts are exact where no ray passes near an edge", "[render][oracle]") {
    const Scene scene = GENERATE(still_life(), random_scene(1), random_scene(2), random_scene(3));
    const oracle::Oracle reference(scene);
    int scenes = 0;
    for (int size = 3; size <= 16; ++size) {
        const oracle::Rendering expected = oracle::render(reference, {size, size}, 4, oracle::EdgeSearch::on);
        if (expected.near_edge_count != 0) continue;
        ++scenes;
        const Rendered rendered = render(scene, square_settings(size, 4));
        INFO("size " << size);
        check_counts(rendered.statistics, expected.generations, 0, 0);
        CHECK(compare(rendered, expected, 1e-3).wrong == 0);
    }
    CHECK(scenes >= 2);
}

TEST_CASE("render: an image does not depend on the scene's scale", "[render]") {
    const double scale = GENERATE(1e-3, 1e3);
    Scene scene = still_life();
    const RenderSettings settings = square_settings(64, 3);
    const oracle::Rendering expected =
        oracle::render(oracle::Oracle(scene), settings.resolution, 3, oracle::EdgeSearch::on);
    scene.transforms[0] = glm::scale(dmat4(1), dvec3(scale));
    for (std::size_t i = 1; i < scene.transforms.size(); ++i)
        scene.transforms[i] = scene.transforms[0] * scene.transforms[i];
    scene.cameras[0].eye *= scale;
    scene.cameras[0].look_at *= scale;
    scene.lights[0].position *= scale;
    scene.lights[0].attenuation /= glm::vec3(1, scale, scale * scale);
    // Scene::transforms[0] stays the identity, so objects without a transform get one of their own.
    scene.transforms.push_back(scene.transforms[0]);
    scene.transforms[0] = dmat4(1);
    for (Primitive& primitive : scene.primitives) {
        if (primitive.transform == 0)
            primitive.transform = static_cast<std::uint32_t>(scene.transforms.size() - 1);
    }
    const Comparison comparison = compare(render(scene, settings), expected, 1e-3);
    CHECK(comparison.compared > 4096 * 8 / 10);
    CHECK(comparison.wrong == 0);
}

}  // namespace
}  // namespace sahl::tests
