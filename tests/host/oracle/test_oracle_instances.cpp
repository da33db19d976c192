// The oracle's groups and instances: numbers, nesting, order, normals.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"

namespace sahl::oracle {
namespace {

using glm::dmat4;
using glm::dvec3;

dmat4 moved(const dvec3& by) { return glm::translate(dmat4(1), by); }

std::optional<Hit> down_at(const Scene& scene, double x, double y, const SurfaceId& start = {}) {
    return Oracle(scene).closest_hit({{x, y, 100}, {0, 0, -1}}, 0, infinity, start);
}

/// A square in the world; groups: a square; nothing but an instance of it; both.
Scene nested() {
    Scene scene;
    add_square(scene, 0, 1, {});
    const std::uint32_t leaf = add_group(scene);
    add_square(scene, 0, 1, {});
    const std::uint32_t wrapper = add_group(scene);
    const std::uint32_t both = add_group(scene);
    add_square(scene, 1, 1, {});
    add_instance(scene, wrapper, leaf, moved({0, 10, 0}));
    add_instance(scene, both, wrapper, moved({10, 0, 0}));
    add_instance(scene, both, leaf, moved({20, 0, 0}));
    add_instance(scene, both, moved({0, 100, 0}));
    add_instance(scene, leaf, moved({0, 200, 0}));
    add_instance(scene, both, moved({0, 300, 0}));
    return scene;
}

TEST_CASE("oracle: instances are numbered depth first, each before its own", "[oracle]") {
    const Scene scene = nested();
    const auto check = [&](double x, double y, double z, std::uint32_t instance, std::uint32_t primitive) {
        const auto hit = down_at(scene, x, y);
        REQUIRE(hit);
        CHECK(hit->position.z == z);
        CHECK(hit->id.instance == instance);
        CHECK(hit->id.primitive == primitive);
    };
    check(0, 0, 0, 0, 0);
    check(0, 100, 1, 1, 2);   // both; the wrapper in it has number 2
    check(10, 110, 0, 3, 1);  // leaf in wrapper in both
    check(20, 100, 0, 4, 1);  // leaf in both
    check(0, 200, 0, 5, 1);   // leaf
    check(0, 300, 1, 6, 2);   // both again
    check(10, 310, 0, 8, 1);
    check(20, 300, 0, 9, 1);
    CHECK_FALSE(down_at(scene, 10, 100));
    const std::vector<dmat4> placements = instance_placements(scene);
    REQUIRE(placements.size() == 9);
    CHECK(dvec3(placements[7][3]) == dvec3(10, 310, 0));
}

TEST_CASE("oracle: a ray leaves its primitive in its instance, not the others", "[oracle]") {
    Scene scene;
    const std::uint32_t group = add_group(scene);
    add_square(scene, 0, 1, {});
    add_instance(scene, group, dmat4(1));
    add_instance(scene, group, moved({0, 0, -2}));
    const auto first = down_at(scene, 0, 0);
    REQUIRE(first);
    CHECK(first->id == SurfaceId{0, 1});
    const auto second = down_at(scene, 0, 0, first->id);
    REQUIRE(second);
    CHECK(second->id == SurfaceId{0, 2});
    CHECK(second->position.z == -2);
}

TEST_CASE("oracle: of two hits at the same distance the lower (instance, primitive) wins", "[oracle]") {
    Scene scene;
    const std::uint32_t low = add_group(scene);
    add_square(scene, 0, 1, {});
    const std::uint32_t high = add_group(scene);
    add_square(scene, 0, 1, {});
    add_instance(scene, high, dmat4(1));
    add_instance(scene, low, dmat4(1));
    CHECK(down_at(scene, 0, 0)->id == SurfaceId{1, 1});
    Scene with_world = scene;
    with_world.groups[0].first_primitive = 1;  // the first square is the world's
    with_world.groups[0].primitive_count = 0;
    CHECK(down_at(with_world, 0, 0)->id == SurfaceId{0, 0});
}

// Whatever the transforms on the way, an instance looks like its primitives with the product.
TEST_CASE("oracle: nested transforms are their product", "[oracle]") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] {
        const double x = uniform(random), y = uniform(random);
        return dvec3(x, y, uniform(random));
    };
    const auto transform = [&] {
        dmat4 m(1);
        do {
            for (int column = 0; column < 3; ++column) m[column] = glm::dvec4(1.5 * vector(), 0);
        } while (std::abs(glm::determinant(m)) < 0.3);
        m[3] = glm::dvec4(vector(), 1);
        return m;
    };
    int hits = 0;
    for (int round = 0; round < 300; ++round) {
        const dmat4 own = transform(), inner = transform(), outer = transform();
        Scene baked, scene;
        const std::uint32_t leaf = add_group(scene);
        const auto add = [&](Scene& to, const dmat4& m) {
            if (round % 3 == 0) add_sphere(to, {{0.1, 0.2, 0.3}, 0.8}, {}, m);
            if (round % 3 == 1) add_box(to, {{-0.5, -1, -0.7}, {0.5, 0.3, 0.9}}, {}, m);
            if (round % 3 == 2) add_cone(to, {{0, 0, -1}, {0, 0.2, 1}, 0.4, 0.9, true}, {}, m);
        };
        add(scene, own);
        const std::uint32_t middle = add_group(scene);
        add_instance(scene, middle, leaf, inner);
        add_instance(scene, middle, outer);
        add(baked, outer * inner * own);
        const dvec3 origin = 5.0 * vector();
        const Ray ray{origin, vector() - origin};
        const auto expected = Oracle(baked).closest_hit(ray);
        const auto hit = Oracle(scene).closest_hit(ray);
        REQUIRE(hit.has_value() == expected.has_value());
        if (!hit) continue;
        ++hits;
        CHECK(hit->id == SurfaceId{0, 2});
        CHECK(hit->t == Approx(expected->t));
        CHECK(glm::distance(hit->ng, expected->ng) < 1e-9);
        CHECK(glm::distance(hit->uv, expected->uv) < 1e-9);
    }
    CHECK(hits > 40);
}

TEST_CASE("oracle: instances throw shadows, clear ones coloured", "[oracle]") {
    Scene scene;
    add_square(scene, 0, 10, matte(glm::vec3(1)));
    const std::uint32_t group = add_group(scene);
    add_square(scene, 0, 1, glass({0.5F, 0.25F, 1}, 1.5F));
    add_instance(scene, group, moved({0, 0, 1}));
    add_instance(scene, group, glm::scale(moved({0, 0, 2}), dvec3(-2, 3, 0.5)));
    scene.lights = {directional_light({0, 0, 1})};
    const PathRecord record = Oracle(scene).trace({{6, 0, 3}, {-6, 0, -3}}, 0);
    CHECK(glm::distance(record.radiance[0], dvec3(0.25, 0.0625, 1)) < 1e-12);
}

}  // namespace
}  // namespace sahl::oracle
