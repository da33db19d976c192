// Ray trees of single pixels, against the image that they are of.
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/self_test/every_feature.h"
#include "tests/render/rendered.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

FixedColor operator+(const FixedColor& a, const FixedColor& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

RenderSettings settings_of(int width, int height, int depth, int spp) {
    RenderSettings settings;
    settings.resolution = {width, height};
    settings.depth = depth;
    settings.spp = spp;
    settings.seed = 7;
    return settings;
}

}  // namespace

TEST_CASE("explain: the rays' contributions add up to the film's pixel, exactly", "[render][explain]") {
    const Scene scene = every_feature();
    Renderer renderer(test_device(), scene);
    RenderSettings settings = settings_of(64, 48, 6, GENERATE(1, 40));
    Film film(test_device().memory(), 64, 48);
    renderer.render(settings, film);
    settings.ray_budget = GENERATE(64U, 1U << 15U);  // with batches that wait, and without
    std::mt19937 random(11);
    int branching = 0;
    const int pixels = full_tests() ? 250 : 15;  // for each of the four settings
    for (int i = 0; i < pixels; ++i) {
        const int x = static_cast<int>(random() % 64);
        const int y = static_cast<int>(random() % 48);
        INFO("pixel " << x << "," << y);
        const Explanation explanation = renderer.explain(settings, x, y);
        REQUIRE(explanation.sum == film.sum(static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)));
        FixedColor sum{};
        for (const ExplainedRay& ray : explanation.rays) sum = sum + ray.fixed;
        REQUIRE(sum == explanation.sum);
        branching += explanation.rays.size() > 10 ? 1 : 0;
    }
    CHECK(branching > pixels / 10);
}

TEST_CASE("explain: rays start where their parents end, and lights arrive as far as nothing is in between",
          "[render][explain]") {
    Renderer renderer(test_device(), every_feature());
    RenderSettings settings = settings_of(64, 48, 4, 2);
    settings.ray_budget = 64;
    std::size_t children = 0;
    std::size_t blocked = 0;
    for (int i = 0; i < 24; ++i) {
        const Explanation explanation = renderer.explain(settings, 7 + 2 * i, 12 + i);
        for (const ExplainedRay& ray : explanation.rays) {
            for (const ExplainedLight& light : ray.lights) {
                CHECK(glm::all(glm::lessThanEqual(glm::abs(light.arriving), glm::abs(light.unshadowed))));
                blocked += light.arriving != light.unshadowed ? 1U : 0U;
            }
            const ExplainedRay& parent = explanation.rays.at(ray.parent);
            CHECK(parent.sample == ray.sample);
            if (ray.from == RayOrigin::camera) {
                CHECK(ray.generation == 0);
                CHECK(ray.weight == glm::vec3(1));
                continue;
            }
            ++children;
            CHECK(ray.generation == parent.generation + 1);
            REQUIRE(parent.primitive != no_aov_id);
            const glm::vec3 end = parent.origin + parent.t * parent.direction;
            CHECK(glm::distance(ray.origin, end) < 1e-3F);
            CHECK(glm::all(glm::lessThanEqual(ray.weight, 2.0F * parent.weight)));
        }
    }
    CHECK(children > 50);
    CHECK(blocked > 50);
}

}  // namespace sahl::tests
