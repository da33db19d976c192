// Everything that a scene can have in one image, against the oracle.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/self_test/every_feature.h"
#include "tests/render/oracle_image.h"

namespace sahl::tests {
namespace {

using glm::dmat4;
using glm::dvec3;

TEST_CASE("render: a scene with every feature is the oracle's, pixel by pixel", "[render][oracle]") {
    const Scene scene = every_feature();
    const oracle::Oracle reference(scene);
    Renderer renderer(test_device(), scene);
    for (const int depth : {0, 4}) {
        const RenderSettings settings = square_settings(128, depth);
        const Rendered rendered = render(renderer, settings);
        const oracle::Rendering expected =
            oracle::render(reference, settings.resolution, depth, oracle::EdgeSearch::on);
        const Comparison comparison = compare(rendered, expected, 1e-3);
        INFO("depth " << depth << ": " << comparison.compared << " of 16384 pixels compared");
        CHECK(comparison.compared > 16384 * 7 / 10);
        CHECK(comparison.wrong == 0);
        CHECK(comparison.mean < 5e-6);
        check_counts(rendered.statistics, expected.generations, 2e-4, 3);
    }
}

/// Primitives of all kinds in nested groups, placed at random; every material in turn.
Scene random_instances(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] {
        const double x = uniform(random);
        const double y = uniform(random);
        return dvec3(x, y, uniform(random));
    };
    const auto placement = [&](double reach, double size) {
        dmat4 m = glm::translate(dmat4(1), reach * vector());
        m = glm::rotate(m, 3 * uniform(random), vector());
        m = glm::scale(m, size * (1.0 + 0.4 * vector()));
        if (uniform(random) < 0) m[0] = -m[0];
        m[2] += 0.4 * uniform(random) * m[1];
        return m;
    };
    Scene scene;
    scene.cameras[0] = {{0.5, -9, 1}, {0, 0, 0}, {0.1, 0, 1}, 38};
    scene.background = glm::vec3(0.5 + 0.4 * vector());
    scene.lights = {oracle::point_light({5, -6, 7}),
                    oracle::spot_light({-6, -3, 2}, {6, 3, -2}, 10, 25, {0.7F, 0.6F, 0.5F})};
    int count = 0;
    const auto add_things = [&](int things) {
        for (int i = 0; i < things; ++i, ++count) {
            Material material;
            material.ambient = 0.1F * glm::vec3(1);
            material.diffuse = glm::vec3(0.5 + 0.4 * vector());
            if (count % 3 == 0) material.reflection = glm::vec3(0.4F);
            if (count % 4 == 1) material = oracle::glass({0.7F, 0.8F, 0.9F}, 1.4F);
            if (count % 5 == 2) material.reflection_attenuation = {1, 0.3F, 0.1F};
            if (count % 8 == 1) material.ior_outside = 1.7F;
            const dmat4 m = placement(1, 0.5);
            switch (count % 6) {
                case 0:
                    oracle::add_box(scene, {{-1, -0.5, -0.8}, {0.7, 0.9, 0.6}}, material, m);
                    break;
                case 1:
                    oracle::add_cone(scene, {{0, 0, -1}, {0, 0, 1}, 0.8, 0.5 + 0.5 * uniform(random), true},
                                     material, m);
                    break;
                case 2:
                    oracle::add_disc(scene, {0.3 * vector(), vector(), 1}, material, m);
                    break;
                case 3:
                    oracle::add_sphere(scene, {0.3 * vector(), 0.8}, material, m);
                    break;
                case 4:
                    oracle::add_triangle(scene, {vector(), vector(), vector()}, material, m);
                    break;
                default:
                    oracle::add_polygon(scene,
                                        {{-1, -1, 0}, {1, -1, 0}, {0.2F, 0, 0}, {1, 1, 0}, {-1, 0.9F, 0}},
                                        material, m);
            }
            if (count % 7 == 0) scene.primitives.back().sides = count % 2 == 0 ? Sides::front : Sides::back;
        }
    };
    add_things(6);
    const std::uint32_t low = oracle::add_group(scene);
    add_things(4);
    const std::uint32_t high = oracle::add_group(scene);
    add_things(3);
    oracle::add_instance(scene, high, low, placement(1, 0.8));
    for (const std::uint32_t group : {low, high, high}) oracle::add_instance(scene, group, placement(1.8, 1));
    return scene;
}

TEST_CASE("render: random instances are the oracle's, pixel by pixel", "[render][oracle]") {
    const unsigned seed = GENERATE(range(1U, 7U));
    const Scene scene = random_instances(seed);
    const RenderSettings settings = square_settings(56, 3);
    const Rendered rendered = render(scene, settings);
    const oracle::Rendering expected =
        oracle::render(oracle::Oracle(scene), settings.resolution, 3, oracle::EdgeSearch::on);
    const Comparison comparison = compare(rendered, expected, 1e-3);
    INFO("seed " << seed << ": " << comparison.compared << " of 3136 pixels compared");
    CHECK(comparison.compared > 3136 * 6 / 10);
    CHECK(comparison.wrong == 0);
    CHECK(comparison.mean < 5e-6);
    check_counts(rendered.statistics, expected.generations, 2e-4, 3);
}

TEST_CASE("render: with instances too, neither ray budget nor crop changes a bit", "[render]") {
    Renderer renderer(test_device(), every_feature());
    RenderSettings settings = square_settings(32, 4);
    settings.spp = 2;
    const Rendered whole = render(renderer, settings);
    for (const std::uint32_t budget : {64U, 999U, 1U << 20U}) {
        settings.ray_budget = budget;
        INFO("budget " << budget);
        CHECK(render(renderer, settings).image.pixels == whole.image.pixels);
    }
    settings.crop = Crop{3, 7, 20, 31};
    const Rendered part = render(renderer, settings);
    int wrong = 0;
    for (int y = 7; y < 31; ++y) {
        for (int x = 3; x < 20; ++x) wrong += part.at(x - 3, y - 7) == whole.at(x, y) ? 0 : 1;
    }
    CHECK(wrong == 0);
}

TEST_CASE("render: every_feature has every feature", "[render]") {
    const Scene scene = every_feature();
    for (const PrimitiveKind kind : {PrimitiveKind::triangle, PrimitiveKind::polygon, PrimitiveKind::sphere,
                                     PrimitiveKind::cone, PrimitiveKind::disc, PrimitiveKind::box}) {
        const auto is_kind = [&](const Primitive& primitive) { return primitive.kind == kind; };
        CHECK(std::any_of(scene.primitives.begin(), scene.primitives.end(), is_kind));
    }
    // Most of its primitives are seen, and so are instances of instances.
    const oracle::Oracle reference(scene);
    std::vector<int> seen(scene.primitives.size());
    std::uint32_t deepest = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const auto hit = reference.closest_hit(pixel_ray(scene, square_settings(128, 0), x, y));
            if (!hit) continue;
            ++seen[hit->id.primitive];
            deepest = std::max(deepest, hit->id.instance);
        }
    }
    CHECK(std::count(seen.begin(), seen.end(), 0) <= 1);
    CHECK(deepest == 7);
}

}  // namespace
}  // namespace sahl::tests
