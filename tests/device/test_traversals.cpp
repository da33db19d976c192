// All ways of traversal (kernels/traverse_*.h) in all versions of kernels/simd.h: the same bits, whatever the
// rays, and what a search of all leaves and the oracle say. RayTracer compares the kernels with each other.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/device/closed_meshes.h"
#include "tests/device/ray_sets.h"
#include "tests/device/ray_verdict.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

// As for primitives alone (test_primitives.cpp).
constexpr double kTraversalRoundings = 8;

struct TraversalScore {
    int sure = 0, wrong = 0;
};

/// Every `step`-th ray's hit against the oracle's.
void compare_with_oracle(const Soup& soup, const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                         std::size_t step, TraversalScore& score) {
    const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(soup.scene);
    for (std::size_t i = 0; i < rays.size(); i += step) {
        const Verdict verdict = judge(shapes, soup.targets, rays[i], kTraversalRoundings);
        if (!verdict.sure) continue;
        ++score.sure;
        const double t = static_cast<double>(hits[i].t), slack = 4 * 0x1p-24 * t;
        bool right = hits[i].primitive == verdict.primitive;
        if (right && hits[i].hit()) {
            right = hits[i].instance == verdict.instance && t >= verdict.t_least - slack &&
                    t <= verdict.t_most + slack;
        }
        score.wrong += !right;
    }
}

/// Each kind of primitive many times in one place: whatever is hit, the first of its kind is.
Soup pile(Random& random) {
    Soup soup;
    for (int kind = 0; kind < shape_kind_count; ++kind) {
        const dvec3 at(vec3(3.0 * in_ball(random)));
        Target target =
            add_random_shape(soup.scene, random, static_cast<ShapeKind>(kind), at, 1, kind % 2 == 0);
        for (int copy = 0; copy < 30; ++copy) {
            if (copy > 0) {
                target.id = static_cast<std::uint32_t>(soup.scene.primitives.size());
                soup.scene.primitives.push_back(soup.scene.primitives.back());
            }
            soup.targets.push_back(target);
        }
    }
    return soup;
}

std::vector<std::pair<std::string, Soup>> soups(Random& random) {
    std::vector<std::pair<std::string, Soup>> result;
    result.emplace_back("crowd", random_soup(random, 48, 1, 0));
    result.emplace_back("large crowd far away", random_soup(random, 48, 1e3, 1e5));
    result.emplace_back("instances", instanced_soup(random, 1, 0));
    result.emplace_back("large instances far away", instanced_soup(random, 1e3, 1e5));
    result.emplace_back("walls on the faces of boxes", axis_parallel_soup(random, 60));
    result.emplace_back("pile", pile(random));
    return result;
}

}  // namespace

TEST_CASE("every traversal finds what a search of all leaves and the oracle find, rays of all kinds") {
    RayTracer tracer;
    Random random(71);
    const std::size_t count = full_tests() ? 20'000 : 4000;
    TraversalScore score;
    for (int round = 0; round < (full_tests() ? 30 : 1); ++round) {
        for (const auto& [soup_name, soup] : soups(random)) {
            DeviceScene scene = tracer.upload(soup.scene);
            for (const auto& [set_name, rays] : ray_sets(random, soup, count)) {
                CAPTURE(soup_name, set_name);
                const std::vector<TestHit> hits = tracer.intersect(scene, rays);
                CHECK(differences(rays, hits, tracer.brute_force(scene, rays)) == "");
                compare_with_oracle(soup, rays, hits, rays.size() / 60, score);
                CHECK(std::count_if(hits.begin(), hits.end(), [](const TestHit& hit) { return hit.hit(); }) >
                      static_cast<int>(rays.size() / 20));
            }
        }
    }
    CHECK(score.sure > 500);
    // Where a rim meets the silhouette, all moved rays can pass beside what the kernels hit.
    CHECK(score.wrong <= score.sure / 1000);
}

TEST_CASE("every traversal finds the same at many small triangles, from near and far") {
    RayTracer tracer;
    Random random(72);
    std::vector<std::pair<std::string, ClosedMesh>> meshes;
    meshes.emplace_back("sphere", icosphere(random, 5, 1, 0.1, dvec3(3, -7, 11)));
    meshes.emplace_back("needles", crumpled(icosphere(random, 5, 1, 0.1, dvec3(0)), 0.03125F));
    meshes.emplace_back("quadrangles", quadrangle_cube(random, 12, 1, dvec3(0)));
    for (const auto& [name, mesh] : meshes) {
        CAPTURE(name);
        Soup soup{mesh.scene(), {}};
        for (const std::vector<std::uint32_t>& face : mesh.faces) {
            Target target;
            target.id = static_cast<std::uint32_t>(soup.targets.size());
            target.center = dvec3(mesh.vertices[face[0]]);
            target.size = std::max(glm::distance(target.center, dvec3(mesh.vertices[face[1]])), 1e-3);
            for (const std::uint32_t vertex : face)
                target.points.push_back({dvec3(mesh.vertices[vertex]), unit_vector(random)});
            soup.targets.push_back(target);
        }
        DeviceScene scene = tracer.upload(soup.scene);
        for (const auto& [set_name, rays] : ray_sets(random, soup, full_tests() ? 200'000 : 10'000)) {
            CAPTURE(set_name);
            const std::vector<TestHit> hits = tracer.intersect(scene, rays);
            const std::vector<TestRay> some(rays.begin(), rays.begin() + 200);
            CHECK(differences(some, hits, tracer.brute_force(scene, some)) == "");
            CHECK(std::count_if(hits.begin(), hits.end(), [](const TestHit& hit) { return hit.hit(); }) >
                  static_cast<int>(rays.size() / 4));
        }
    }
}

// Streams leave out what lies behind a ray's origin before they know the distance, packets do not.
TEST_CASE("rays that start on triangles or a rounding away find what lies just ahead, slivers too") {
    RayTracer tracer;
    Random random(77);
    for (const double offset : {0.0, 30.0}) {
        for (const double thickness : {1.0, 1e-2, 1e-5}) {
            CAPTURE(offset, thickness);
            const dvec3 center = offset * unit_vector(random);
            Scene scene;
            std::vector<TestRay> rays;
            for (int i = 0; i < 200; ++i) {
                const dvec3 along = unit_vector(random), across = thickness * unit_vector(random);
                const dvec3 at = center + dvec3(in_ball(random)) * 2.0;
                const vec3 corners[] = {vec3(at), vec3(at + along),
                                        vec3(at + uniform(random, 0, 1) * along + across)};
                oracle::add_triangle(scene, {corners[0], corners[1], corners[2]}, Material{});
                const dvec3 normal =
                    glm::cross(dvec3(corners[1] - corners[0]), dvec3(corners[2] - corners[0]));
                for (int k = 0; k < 50; ++k) {
                    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1 - u);
                    const dvec3 on =
                        (1 - u - v) * dvec3(corners[0]) + u * dvec3(corners[1]) + v * dvec3(corners[2]);
                    const double away = std::pow(10.0, uniform(random, -9, -2)) * (k % 2 == 0 ? 1 : -1);
                    const vec3 from(on + away * glm::normalize(normal));
                    // At the triangle, or anywhere.
                    const vec3 aim = k % 3 == 0 ? vec3(unit_vector(random))
                                                : vec3(on + 0.1 * along * uniform(random, -1, 1)) - from;
                    rays.push_back({from, aim});
                }
            }
            const std::vector<TestHit> hits = tracer.intersect(tracer.upload(scene), rays);
            CHECK(std::count_if(hits.begin(), hits.end(),
                                [](const TestHit& hit) { return hit.hit() && hit.t < 1; }) > 1000);
        }
    }
}

TEST_CASE("batches of any size: each ray is traced, and nothing behind the last") {
    RayTracer tracer;
    Random random(73);
    const Soup soup = random_soup(random, 60, 1, 0);
    DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<TestRay> rays = ray_sets(random, soup, 2049)[0].rays;
    const std::vector<TestHit> wanted = tracer.brute_force(scene, rays);
    for (const std::ptrdiff_t count :
         {0,  1,  3,  7,  8,  9,  15,  16,  17,  19,  20,  21,  27,   28,   29,   31,   32,  33,
          39, 40, 41, 63, 64, 65, 127, 128, 129, 255, 256, 257, 1023, 1024, 1025, 2047, 2049}) {
        CAPTURE(count);
        const std::vector<TestRay> batch(rays.begin(), rays.begin() + count);
        const std::vector<TestHit> hits = tracer.intersect(scene, batch);
        REQUIRE(hits.size() == batch.size());
        CHECK(differences(batch, hits, wanted) == "");
    }
}

TEST_CASE("rays that meet nothing do not disturb their neighbours") {
    RayTracer tracer;
    Random random(74);
    const Soup soup = instanced_soup(random, 1, 0);
    DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<TestRay> bad = bad_rays();
    for (const auto& [name, good] : ray_sets(random, soup, 3000)) {
        CAPTURE(name);
        const std::vector<TestHit> wanted = tracer.brute_force(scene, good);
        for (const std::size_t period : {2U, 5U, 16U, 17U, 100U}) {
            // Bad rays alone, last, first, and sixteen in a row as well.
            std::vector<TestRay> rays;
            std::vector<TestHit> expected;
            for (std::size_t i = 0; i < good.size(); ++i) {
                const bool spoil = i % period == 0 || i / 16 % 7 == 3;
                rays.push_back(spoil ? bad[i % bad.size()] : good[i]);
                expected.push_back(
                    spoil ? TestHit{std::numeric_limits<float>::infinity(), 0, 0, SAHL_NO_PRIMITIVE, 0}
                          : wanted[i]);
            }
            CHECK(differences(rays, tracer.intersect(scene, rays), expected) == "");
        }
    }
}

TEST_CASE("directions of all lengths, from denormal to huge, are traced alike") {
    RayTracer tracer;
    Random random(75);
    const Soup soup = random_soup(random, 60, 1, 0);
    const DeviceScene scene = tracer.upload(soup.scene);
    std::vector<TestRay> rays = random_rays(random, soup, 20'000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const vec3 unit(glm::normalize(dvec3(rays[i].direction)));
        rays[i].direction = unit * static_cast<float>(std::pow(10.0, uniform(random, -44, 38)));
        if (i % 3 == 0) rays[i].direction[static_cast<int>(i / 3 % 3)] *= 1e-30F;
        if (i % 4 == 0) rays[i].origin *= static_cast<float>(std::pow(10.0, uniform(random, -10, 30)));
    }
    for (const TestHit& hit : tracer.intersect(scene, rays)) {
        if (hit.hit()) CHECK((hit.primitive < soup.scene.primitives.size() && hit.t > 0));
    }
}

// The bounds are those of kernels/hit.h.
TEST_CASE("directions times a power of two: the same hits, t divided by it, of primitives of all sizes") {
    RayTracer tracer;
    Random random(78);
    for (const double size : {1e-9, 1e-4, 1.0, 1e4, 1e9}) {
        const Soup soup = random_soup(random, 48, size, 0);
        const DeviceScene scene = tracer.upload(soup.scene);
        std::vector<TestRay> rays = random_rays(random, soup, 20'000);
        for (TestRay& ray : rays) ray.direction = vec3(glm::normalize(dvec3(ray.direction)));
        const std::vector<TestHit> unit = tracer.intersect(scene, rays);
        for (const int power : {-24, -12, 12, 24, 40}) {
            const double length = std::ldexp(1.0, power);
            if (length > 1.1e9 * size || size > 1.1e9 * length) continue;
            CAPTURE(size, power);
            std::vector<TestRay> scaled = rays;
            std::vector<TestHit> wanted = unit;
            for (TestRay& ray : scaled) ray.direction *= static_cast<float>(length);
            for (TestHit& hit : wanted) hit.t = std::ldexp(hit.t, -power);
            CHECK(differences(scaled, tracer.intersect(scene, scaled), wanted) == "");
        }
    }
}

TEST_CASE("many primitives in one place are one leaf after the other, and the first is hit") {
    RayTracer tracer;
    for (int kind = 0; kind < shape_kind_count; ++kind) {
        CAPTURE(kind);
        Random random(76);
        for (const int count : {1, 5, 500}) {
            CAPTURE(count);
            Soup soup;
            const Target target =
                add_random_shape(soup.scene, random, static_cast<ShapeKind>(kind), dvec3(1, 2, 3), 1, true);
            for (int copy = 1; copy < count; ++copy)
                soup.scene.primitives.push_back(soup.scene.primitives[0]);
            soup.targets = {target};
            const DeviceScene scene = tracer.upload(soup.scene);
            std::vector<TestRay> rays = random_rays(random, soup, 600);
            for (TestRay& ray : rays) ray.exclude = SAHL_NO_PRIMITIVE;
            const std::vector<TestHit> hits = tracer.intersect(scene, rays);
            const std::vector<Occlusion> any =
                tracer.occlusion(scene, rays, std::numeric_limits<float>::infinity());
            int met = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                met += hits[i].hit();
                CHECK((!hits[i].hit() || hits[i].primitive == 0));
                CHECK((any[i] == Occlusion::opaque) == hits[i].hit());
            }
            CHECK(met > 60);
        }
    }
}

}  // namespace sahl::tests
