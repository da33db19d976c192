// kernels/hit.h: which hits a ray takes; rays that meet nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/device/ray_sets.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

/// `count` parallel unit squares at z = 0.5, 1.5, ..., each with a material of its own.
Scene sheets(int count, const std::vector<vec3>& transmissions) {
    Scene scene;
    for (int i = 0; i < count; ++i) {
        Material material;
        material.transmission = transmissions[static_cast<std::size_t>(i) % transmissions.size()];
        oracle::add_square(scene, static_cast<float>(i) + 0.5F, 1, material);
    }
    return scene;
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("rays that are not finite or lead nowhere meet nothing, and none takes for ever") {
    RayTracer tracer;
    Random random(12);
    const Soup soup = random_soup(random, 60, 1, 0);
    const DeviceScene scene = tracer.upload(soup.scene);
    std::vector<TestRay> rays = bad_rays();
    for (const TestHit& hit : tracer.intersect(scene, rays)) CHECK_FALSE(hit.hit());
    for (const Occlusion met : tracer.occlusion(scene, rays, kInfinity)) CHECK((met == Occlusion::nothing));

    // Extreme but finite ones may hit or not; what they hit is sane.
    rays.clear();
    for (const float scale : {1e-38F, 1e-30F, 1e-20F, 1e15F, 1e20F, 1e38F}) {
        for (int i = 0; i < 200; ++i) {
            rays.push_back({vec3(in_ball(random)), scale * vec3(unit_vector(random))});
            rays.push_back({scale * vec3(unit_vector(random)), vec3(unit_vector(random))});
        }
    }
    for (const TestHit& hit : tracer.intersect(scene, rays)) {
        if (hit.hit())
            CHECK((hit.primitive < soup.scene.primitives.size() && hit.t > 0 && hit.t < kInfinity));
    }
}

TEST_CASE("scenes of no, one and few primitives") {
    RayTracer tracer;
    for (const int count : {0, 1, 2, 3, 4, 5, 8, 9, 33}) {
        CAPTURE(count);
        const DeviceScene scene = tracer.upload(sheets(count, {vec3(0)}));
        std::vector<TestRay> rays;
        for (int i = 0; i <= count; ++i) {
            rays.push_back({{0.25F, -0.5F, static_cast<float>(i)}, {0, 0, 2}});
            rays.push_back({{0.25F, -0.5F, static_cast<float>(i)}, {-0.0F, 0, -0.5F}});
            rays.push_back({{1.5F, 0, static_cast<float>(i)}, {0, -0.0F, 1}});
        }
        const std::vector<TestHit> hits = tracer.intersect(scene, rays);
        for (int i = 0; i <= count; ++i) {
            const auto first = 3 * static_cast<std::size_t>(i);
            REQUIRE(hits[first].hit() == (i < count));
            if (i < count)
                REQUIRE((hits[first].primitive == static_cast<std::uint32_t>(i) && hits[first].t == 0.25F));
            REQUIRE(hits[first + 1].hit() == (i > 0));
            if (i > 0)
                REQUIRE((hits[first + 1].primitive == static_cast<std::uint32_t>(i - 1) &&
                         hits[first + 1].t == 1));
            REQUIRE_FALSE(hits[first + 2].hit());
        }
    }
}

TEST_CASE("of surfaces at the same distance the lowest id is hit, and a walk meets each once, in order") {
    RayTracer tracer;
    // Three sheets, the middle one four times, with a sphere and a cylinder around, all see-through.
    Scene scene;
    const Material glass = oracle::glass(vec3(0.5F), 1);
    oracle::add_square(scene, 2, 1, glass);
    for (int i = 0; i < 2; ++i) oracle::add_square(scene, 1, 1, glass);
    oracle::add_sphere(scene, {{0, 0, 1}, 2}, glass);
    oracle::add_triangle(scene, {{-3, -3, 1}, {3, -3, 1}, {0, 3, 1}}, glass);
    oracle::add_square(scene, 1, 1, glass);
    oracle::add_cone(scene, {{0, -9, 1}, {0, 9, 1}, 4, 4}, glass);
    oracle::add_square(scene, 0, 1, glass);
    const DeviceScene device_scene = tracer.upload(scene);
    const std::vector<TestRay> rays{{{0.25F, 0.125F, -10}, {0, 0, 1}}, {{0.25F, 0.125F, 12}, {0, 0, -1}}};
    const std::vector<std::vector<std::uint32_t>> wanted{{6, 3, 7, 1, 2, 4, 5, 0, 3, 6},
                                                         {6, 3, 0, 1, 2, 4, 5, 7, 3, 6}};
    const std::vector<TestWalk> walks = tracer.walk(device_scene, rays, kInfinity);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        CAPTURE(i);
        CHECK(std::vector(walks[i].primitives, walks[i].primitives + walks[i].count) == wanted[i]);
        CHECK(std::is_sorted(walks[i].t, walks[i].t + walks[i].count));
    }
    // The range's end is open: the four sheets at t = 11 are left out.
    CHECK(tracer.walk(device_scene, {rays[0]}, 11)[0].count == 3);
    CHECK(tracer.walk(device_scene, {rays[0]}, std::nextafter(11.0F, 12.0F))[0].count == 7);
}

TEST_CASE("walks meet as many surfaces as the oracle") {
    RayTracer tracer;
    Random random(13);
    const Soup soup = random_soup(random, 24, 1, 0);
    const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(soup.scene);
    std::vector<TestRay> rays;
    for (int i = 0; i < 20000; ++i)
        rays.push_back({vec3(6.0 * unit_vector(random)), vec3(unit_vector(random))});
    const std::vector<TestWalk> walks = tracer.walk(tracer.upload(soup.scene), rays, kInfinity);
    int compared = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        std::vector<double> crossings;
        double margin = 1;
        for (const oracle::PlacedShape& placed : shapes) {
            const oracle::Crossings c =
                placed.shape.cross({dvec3(rays[i].origin), dvec3(rays[i].direction)}, false);
            margin = std::min(margin, c.margin);
            for (int k = 0; k < c.count; ++k) {
                if (c.at[k].t > 0) crossings.push_back(c.at[k].t);
                if (std::abs(c.at[k].t) < 1e-4) margin = 0;
            }
        }
        if (margin < 1e-4 || crossings.size() > TestWalk::longest) continue;
        ++compared;
        std::sort(crossings.begin(), crossings.end());
        REQUIRE(walks[i].count == crossings.size());
        for (std::size_t k = 0; k < crossings.size(); ++k)
            REQUIRE(std::abs(static_cast<double>(walks[i].t[k]) - crossings[k]) < 1e-3);
    }
    CHECK(compared > 10000);
}

TEST_CASE("shadow rays tell opaque from transparent, and do not look beyond their end") {
    RayTracer tracer;
    const TestRay ray{{0.25F, 0.125F, 0}, {0, 0, 1}};
    const auto met = [&](const std::vector<vec3>& transmissions, float t_max,
                         std::uint32_t exclude = SAHL_NO_PRIMITIVE) {
        return tracer.occlusion(tracer.upload(sheets(3, transmissions)),
                                {{ray.origin, ray.direction, exclude}}, t_max)[0];
    };
    const vec3 glass(0.5F), opaque(0);
    CHECK((met({glass}, kInfinity) == Occlusion::transparent));
    CHECK((met({opaque}, kInfinity) == Occlusion::opaque));
    CHECK((met({glass, glass, opaque}, kInfinity) == Occlusion::opaque));
    CHECK((met({glass, glass, opaque}, 2.5F) == Occlusion::transparent));
    CHECK((met({glass, glass, opaque}, 2.75F) == Occlusion::opaque));
    CHECK((met({glass}, 0.5F) == Occlusion::nothing));
    CHECK((met({opaque, glass, glass}, 0.75F, 0) == Occlusion::nothing));
    CHECK((met({opaque, glass, glass}, kInfinity, 0) == Occlusion::transparent));
}

TEST_CASE("triangles without area are not hit beside where they are") {
    RayTracer tracer;
    Random random(15);
    Scene scene;
    // Needles along lines in general and axis-parallel position, in all orders of their corners, and points.
    for (int i = 0; i < 24; ++i) {
        const vec3 a(in_ball(random)), d = i % 3 == 0 ? vec3(0, 0, 0.5F) : vec3(unit_vector(random));
        const vec3 b = a + d, c = i % 2 == 0 ? a + 0.5F * d : a;
        oracle::add_triangle(scene, i % 4 < 2 ? std::vector{a, b, c} : std::vector{c, a, b}, {});
        oracle::add_triangle(scene, {a, a, a}, {});
    }
    std::vector<TestRay> rays;
    for (int i = 0; i < 100'000; ++i) {
        // At points of the needles' lines, on them or past their ends.
        const Triangle& triangle = scene.triangles[static_cast<std::size_t>(i) % scene.triangles.size()];
        const vec3 a = scene.vertices[triangle.vertices[0]], b = scene.vertices[triangle.vertices[1]];
        const vec3 aim = a + static_cast<float>(uniform(random, -3, 4)) * (b - a);
        const vec3 origin = i % 5 == 0 ? aim + 2.0F * (b - a) : vec3(5.0 * unit_vector(random));
        rays.push_back({origin, aim - origin});
    }
    const std::vector<TestHit> hits = tracer.intersect(tracer.upload(scene), rays);
    int met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit()) continue;
        ++met;
        REQUIRE(std::isfinite(hits[i].t));
        const dvec3 at = dvec3(rays[i].origin) + static_cast<double>(hits[i].t) * dvec3(rays[i].direction);
        dvec3 lo(1e9), hi(-1e9);
        for (const std::uint32_t vertex : scene.triangles[hits[i].primitive].vertices) {
            lo = glm::min(lo, dvec3(scene.vertices[vertex]));
            hi = glm::max(hi, dvec3(scene.vertices[vertex]));
        }
        for (int k = 0; k < 3; ++k) REQUIRE((at[k] > lo[k] - 1e-5 && at[k] < hi[k] + 1e-5));
    }
    CHECK(met < 50'000);
}

}  // namespace sahl::tests
