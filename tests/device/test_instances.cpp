// kernels/instance.h and the second level of kernels/traverse_scalar.h: instances, nested, stretched,
// sheared and mirrored, against the oracle, against the same primitives in the world, and against a search
// of all leaves.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/device/ray_verdict.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

constexpr float kNever = std::numeric_limits<float>::infinity();
// As for primitives of the world (test_primitives.cpp).
constexpr double kRoundings = 8;

struct Place {
    double size, offset;
    double unit = 1, flatness = 1;
};

Soup soup_at(Random& random, const Place& place) {
    return instanced_soup(random, place.size, place.offset, place.unit, place.flatness);
}

/// As random_rays(), from no further away than what hit.h says about flat shapes.
std::vector<TestRay> rays_near(Random& random, const Soup& soup, const Place& place, std::size_t count) {
    std::vector<TestRay> rays;
    for (std::size_t i = 0; rays.size() < count; ++i) {
        const Target& target = soup.targets[i % soup.targets.size()];
        const TestRay ray = random_ray(random, target);
        if (reach_of(ray, target) < 1.1e4 * target.size / place.flatness) rays.push_back(ray);
    }
    return rays;
}

using Id = std::pair<std::uint32_t, std::uint32_t>;  ///< instance, primitive

Id id_of(const TestHit& hit) { return {hit.instance, hit.primitive}; }

struct Score {
    int rays = 0, sure = 0, hits = 0, in_instances = 0;
    int wrong = 0, wrong_t = 0, wrong_baked = 0;
    double position = 0, ng = 0;  ///< errors of surface_at() in units of the rounding of traced rays
};

void compare(RayTracer& tracer, Random& random, const Place& place, Score& score) {
    const Soup soup = soup_at(random, place);
    const Soup baked = without_instances(soup);
    std::map<Id, std::size_t> target_of;
    for (std::size_t i = 0; i < soup.targets.size(); ++i)
        target_of[{soup.targets[i].instance, soup.targets[i].id}] = i;
    const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(soup.scene);
    const std::vector<TestRay> rays = rays_near(random, soup, place, 600);
    std::vector<TestRay> baked_rays = rays;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (rays[i].exclude == SAHL_NO_PRIMITIVE) continue;
        baked_rays[i].exclude =
            static_cast<std::uint32_t>(target_of.at({rays[i].exclude_instance, rays[i].exclude}));
        baked_rays[i].exclude_instance = 0;
    }
    const DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<TestHit> hits = tracer.intersect(scene, rays);
    const std::vector<TestHit> baked_hits = tracer.intersect(tracer.upload(baked.scene), baked_rays);
    const std::vector<TestSurface> surfaces = tracer.surfaces(scene, rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestHit& hit = hits[i];
        const Verdict verdict = judge(shapes, soup.targets, rays[i], kRoundings);
        ++score.rays;
        if (!verdict.sure) continue;
        ++score.sure;
        const bool wanted = verdict.primitive != SAHL_NO_PRIMITIVE;
        const Id id{verdict.instance, verdict.primitive};
        score.wrong += hit.hit() != wanted || (wanted && id_of(hit) != id);
        score.wrong_baked +=
            baked_hits[i].hit() != wanted || (wanted && baked_hits[i].primitive != target_of.at(id));
        if (!wanted || !hit.hit() || id_of(hit) != id) continue;
        ++score.hits;
        score.in_instances += hit.instance != 0;
        const double t = static_cast<double>(hit.t), slack = 4 * 0x1p-24 * t;
        // A twin of the surface that the ray starts on, in an instance in the same place, may be met there.
        const bool at_start =
            id.second == rays[i].exclude && t * glm::length(dvec3(rays[i].direction)) < verdict.rounding;
        score.wrong_t += !at_start && (t < verdict.t_least - slack || t > verdict.t_most + slack);
        const Target& target = soup.targets[target_of.at(id)];
        const dvec3 position = dvec3(rays[i].origin) + verdict.crossing.t * dvec3(rays[i].direction);
        const double cosine =
            std::abs(glm::dot(glm::normalize(dvec3(rays[i].direction)), verdict.crossing.ng));
        const double unit = verdict.rounding / cosine;
        // Where the ray grazes the hit may be the target's other crossing.
        const double apart = std::abs(t - verdict.crossing.t) * glm::length(dvec3(rays[i].direction));
        if (!verdict.one_face || cosine < 0.1 || unit > 1e-3 * target.size || apart > unit) continue;
        score.position = std::max(score.position, glm::distance(surfaces[i].position, position) / unit);
        score.ng =
            std::max(score.ng, glm::distance(surfaces[i].ng, verdict.crossing.ng) * target.size / unit);
    }
}

}  // namespace

TEST_CASE("instances are hit where the oracle says and where they would be in the world") {
    RayTracer tracer;
    Random random(61);
    for (const Place& place : std::vector<Place>{{1, 0},
                                                 {1e-3, 0},
                                                 {1e3, 0},
                                                 {1, 1e3},
                                                 {1e-3, 1},
                                                 {1e3, 1e6},
                                                 {100, 1e6},
                                                 {1, 0, 1e6},
                                                 {1, 0, 1e-6},
                                                 {1e-6, 0, 1e-6},
                                                 {1, 0, 1, 100},
                                                 {1, 0, 1e3, 100}}) {
        Score score;
        for (int round = 0; round < (full_tests() ? 40 : 2); ++round) compare(tracer, random, place, score);
        CAPTURE(place.size, place.offset, place.unit, place.flatness, score.rays, score.sure, score.hits,
                score.in_instances);
        CAPTURE(score.position, score.ng);
        CHECK(score.sure > score.rays / 3);
        CHECK(score.hits > score.rays / 8);
        CHECK(score.in_instances > score.hits / 2);
        CHECK(score.wrong <= score.rays / 1000);
        CHECK(score.wrong_baked <= score.rays / 1000);
        CHECK(score.wrong_t == 0);
        CHECK(score.position < 8);
        CHECK(score.ng < 32);
    }
}

TEST_CASE("two levels of trees find what a search of all leaves finds, bit for bit") {
    RayTracer tracer;
    Random random(62);
    for (int round = 0; round < (full_tests() ? 20 : 1); ++round) {
        for (const Place& place :
             std::vector<Place>{{1, 0}, {1e3, 1e5}, {1e-3, 1e-2}, {1, 0, 1e6, 100}, {1, 0, 1e-6, 1e3}}) {
            const Soup soup = soup_at(random, place);
            DeviceScene scene = tracer.upload(soup.scene);
            const std::vector<TestRay> rays = rays_near(random, soup, place, 40'000);
            const std::vector<TestHit> hits = tracer.intersect(scene, rays);
            CHECK(differences(rays, hits, tracer.brute_force(scene, rays)) == "");
            CHECK(std::count_if(hits.begin(), hits.end(),
                                [](const TestHit& hit) { return hit.instance != 0; }) > 10'000);
        }
    }
}

TEST_CASE("of instances in one place the lowest (instance, primitive) is hit, and a walk meets each once") {
    // Squares at z = 1, in the world and twice in a group, the group three times; once more nested.
    Scene scene;
    const Material glass = oracle::glass(vec3(0.5F), 1);
    oracle::add_square(scene, 1, 1, glass);
    const std::uint32_t empty = oracle::add_group(scene);
    const std::uint32_t pair = oracle::add_group(scene);
    oracle::add_square(scene, 1, 1, glass);
    oracle::add_square(scene, 1, 1, glass);
    const std::uint32_t nest = oracle::add_group(scene);
    oracle::add_instance(scene, nest, pair, dmat4(1));
    oracle::add_instance(scene, pair, dmat4(1));                                    // 1
    oracle::add_instance(scene, empty, dmat4(1));                                   // 2
    oracle::add_instance(scene, nest, dmat4(1));                                    // 3, in it 4
    oracle::add_instance(scene, pair, glm::scale(dmat4(1), dvec3(-2, 2, 1)));       // 5
    oracle::add_instance(scene, pair, glm::translate(dmat4(1), dvec3(0, 0, 0.5)));  // 6
    RayTracer tracer;
    const DeviceScene device_scene = tracer.upload(scene);
    const TestRay down{{0.25F, 0.125F, 9}, {0, 0, -1}}, up{{0.25F, 0.125F, -9}, {0, 0, 1}};
    CHECK(id_of(tracer.intersect(device_scene, {up})[0]) == Id{0, 0});
    CHECK(id_of(tracer.intersect(device_scene, {down})[0]) == Id{6, 1});
    const std::vector<Id> low{{0, 0}, {1, 1}, {1, 2}, {4, 1}, {4, 2}, {5, 1}, {5, 2}};
    const std::vector<Id> high{{6, 1}, {6, 2}};
    const std::vector<TestWalk> walks = tracer.walk(device_scene, {up, down}, kNever);
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<Id> met, wanted = i == 0 ? low : high;
        const std::vector<Id>& rest = i == 0 ? high : low;
        wanted.insert(wanted.end(), rest.begin(), rest.end());
        for (std::uint32_t k = 0; k < walks[i].count; ++k)
            met.emplace_back(walks[i].instances[k], walks[i].primitives[k]);
        CHECK(met == wanted);
        CHECK(std::is_sorted(walks[i].t, walks[i].t + walks[i].count));
    }
    // A ray that starts on one of them meets the others.
    TestRay start{{0.25F, 0.125F, 1}, {0, 0, -1}, 1, 4};
    CHECK_FALSE(tracer.intersect(device_scene, {start})[0].hit());
    start.origin.z = 1.25F;
    CHECK(id_of(tracer.intersect(device_scene, {start})[0]) == Id{0, 0});
    start = {{0.25F, 0.125F, 2}, {0, 0, -1}, 1, 6};
    CHECK(id_of(tracer.intersect(device_scene, {start})[0]) == Id{6, 2});
}

TEST_CASE("walks through instances meet as many surfaces as the oracle, shadow rays what kind") {
    RayTracer tracer;
    Random random(63);
    int compared = 0, opaque = 0, transparent = 0;
    for (int round = 0; round < 3; ++round) {
        const Soup soup = instanced_soup(random, 1, 0);
        const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(soup.scene);
        std::vector<TestRay> rays;
        for (int i = 0; i < 4000; ++i) {
            const vec3 origin(8.0 * unit_vector(random));
            rays.push_back({origin, vec3(glm::normalize(4.0 * in_ball(random) - dvec3(origin)))});
        }
        const DeviceScene scene = tracer.upload(soup.scene);
        const std::vector<TestWalk> walks = tracer.walk(scene, rays, kNever);
        const std::vector<Occlusion> met = tracer.occlusion(scene, rays, kNever);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            std::vector<double> crossings;
            double margin = 1;
            Occlusion wanted = Occlusion::nothing;
            for (const oracle::PlacedShape& placed : shapes) {
                const oracle::Crossings c =
                    placed.shape.cross({dvec3(rays[i].origin), dvec3(rays[i].direction)}, false);
                margin = std::min(margin, c.margin);
                for (int k = 0; k < c.count; ++k) {
                    if (std::abs(c.at[k].t) < 1e-4) margin = 0;
                    if (c.at[k].t <= 0) continue;
                    crossings.push_back(c.at[k].t);
                    const std::uint32_t material = soup.scene.primitives[placed.primitive].material;
                    const bool clear = soup.scene.materials[material].transmission != vec3(0);
                    wanted =
                        clear && wanted != Occlusion::opaque ? Occlusion::transparent : Occlusion::opaque;
                }
            }
            if (margin < 1e-4 || crossings.size() > TestWalk::longest) continue;
            ++compared;
            std::sort(crossings.begin(), crossings.end());
            REQUIRE(walks[i].count == crossings.size());
            for (std::size_t k = 0; k < crossings.size(); ++k)
                REQUIRE(std::abs(static_cast<double>(walks[i].t[k]) - crossings[k]) < 1e-3);
            REQUIRE((met[i] == wanted));
            opaque += wanted == Occlusion::opaque;
            transparent += wanted == Occlusion::transparent;
        }
    }
    CHECK(compared > 5000);
    CHECK(opaque > 1000);
    CHECK(transparent > 100);
}

TEST_CASE("instances of nothing, and instances without a world") {
    RayTracer tracer;
    Scene scene;
    const std::uint32_t empty = oracle::add_group(scene);
    oracle::add_instance(scene, empty, dmat4(1));
    const TestRay ray{{0.25F, 0.125F, 9}, {0, 0, -1}};
    CHECK_FALSE(tracer.intersect(tracer.upload(scene), {ray})[0].hit());
    const std::uint32_t group = oracle::add_group(scene);
    oracle::add_square(scene, 1, 1, {});
    CHECK_FALSE(tracer.intersect(tracer.upload(scene), {ray})[0].hit());  // not placed
    oracle::add_instance(scene, group, glm::scale(dmat4(1), dvec3(1, 1, 2)));
    const TestHit hit = tracer.intersect(tracer.upload(scene), {ray})[0];
    CHECK(id_of(hit) == Id{2, 0});
    CHECK(hit.t == 7);
}

}  // namespace sahl::tests
