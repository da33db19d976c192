// No ray slips between faces that share vertices, whichever way of traversal in whichever version of
// kernels/simd.h traces it (RayTracer compares them), for its closest hit or for any.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/device/closed_meshes.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

/// How many rays do not hit the scene, as the closest hit or as any; for a message, the first of them.
int misses(RayTracer& tracer, const DeviceScene& scene, const std::vector<TestRay>& rays) {
    const std::vector<TestHit> hits = tracer.intersect(scene, rays);
    const std::vector<Occlusion> met = tracer.occlusion(scene, rays, std::numeric_limits<float>::infinity());
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].hit() && hits[i].t > 0 && met[i] == Occlusion::opaque) continue;
        if (++count > 3) continue;
        const TestRay& ray = rays[i];
        UNSCOPED_INFO((hits[i].hit() ? "any hit" : "closest hit")
                      << ", ray " << i << " from " << ray.origin.x << " " << ray.origin.y << " "
                      << ray.origin.z << " along " << ray.direction.x << " " << ray.direction.y << " "
                      << ray.direction.z);
    }
    return count;
}

/// Of `total` rays at the mesh.
int leaks(RayTracer& tracer, Random& random, const ClosedMesh& mesh, std::size_t total) {
    const DeviceScene scene = tracer.upload(mesh.scene());
    int count = 0;
    for (std::size_t left = total; left > 0;) {
        const std::size_t batch = std::min<std::size_t>(left, 1U << 16U);
        count += misses(tracer, scene, rays_at(random, mesh, batch));
        left -= batch;
    }
    return count;
}

}  // namespace

TEST_CASE("no ray leaks through a closed mesh") {
    RayTracer tracer;
    Random random(21);
    const glm::dvec3 origin(0), near(3, -7, 11), far(6e5, -5e5, 3e5);
    std::vector<std::pair<std::string, ClosedMesh>> meshes;
    meshes.emplace_back("rough sphere", icosphere(random, 4, 1, 0.2, origin));
    meshes.emplace_back("tiny rough sphere", icosphere(random, 3, 1e-3, 0.2, near * 0.01));
    meshes.emplace_back("huge rough sphere far away", icosphere(random, 3, 1e3, 0.2, far));
    meshes.emplace_back("rough sphere beyond its precision", icosphere(random, 3, 3, 0.2, far));
    meshes.emplace_back("crumpled sphere", crumpled(icosphere(random, 4, 1, 0.1, origin), 0.125F));
    meshes.emplace_back("sphere of needles", crumpled(icosphere(random, 5, 1, 0.1, near), 0.03125F));
    meshes.emplace_back("cube of quadrangles", quadrangle_cube(random, 12, 1, near));
    meshes.emplace_back("cube of quadrangles far away", quadrangle_cube(random, 5, 100, far));
    meshes.emplace_back("cube of zigzags", zigzag_cube(random, 1, origin));
    meshes.emplace_back("cube of zigzags far away", zigzag_cube(random, 100, far));
    // 1 million rays, or 100 million, in all: each of them by every kernel, for its closest hit and for any.
    const std::size_t rays = (full_tests() ? 100'000'000U : 1'000'000U) / meshes.size();
    for (const auto& [name, mesh] : meshes) {
        CAPTURE(name);
        CHECK(leaks(tracer, random, mesh, rays) == 0);
    }
}

TEST_CASE("no ray leaks through instances of closed meshes") {
    RayTracer tracer;
    Random random(23);
    struct Case {
        std::string name;
        ClosedMesh mesh;
        double size, offset;  ///< in the world
    };
    const glm::dvec3 origin(0), near(3, -7, 11);
    std::vector<Case> cases;
    cases.push_back({"rough sphere", icosphere(random, 3, 1, 0.2, origin), 1, 0});
    cases.push_back({"tiny", icosphere(random, 3, 1, 0.2, near), 1e-3, 0.1});
    cases.push_back({"huge and far away", icosphere(random, 3, 1e-2, 0.2, near), 1e5, 1e6});
    cases.push_back({"crumpled", crumpled(icosphere(random, 4, 1, 0.1, origin), 0.125F), 10, 100});
    cases.push_back({"quadrangles", quadrangle_cube(random, 8, 1, near), 1, 30});
    cases.push_back({"zigzags", zigzag_cube(random, 1, origin), 1, 3});
    const std::size_t count = full_tests() ? 2'000'000 : 60'000;
    for (const auto& [name, mesh, size, offset] : cases) {
        CAPTURE(name);
        glm::dmat4 placement(random_linear(random) * size);
        placement[3] = glm::dvec4(offset * unit_vector(random), 1);
        Scene scene = mesh.scene();
        scene.groups.push_back({"mesh", 0, static_cast<std::uint32_t>(scene.primitives.size()), {}});
        oracle::add_instance(scene, 0, placement);
        std::vector<TestRay> rays = rays_at(random, mesh, count);
        for (TestRay& ray : rays) {
            const auto to_world = [&](const glm::vec3& p) {
                return glm::dvec3(placement * glm::dvec4(glm::dvec3(p), 1));
            };
            const glm::dvec3 aim = to_world(ray.origin + ray.direction);
            ray.origin = glm::vec3(to_world(ray.origin));
            ray.direction = glm::vec3(aim - glm::dvec3(ray.origin));
        }
        CHECK(misses(tracer, tracer.upload(scene), rays) == 0);
    }
}

// Rays from within aim at the surface, most of them at rims, edges and corners.
TEST_CASE("no ray leaves a solid unseen, in the world or in an instance") {
    RayTracer tracer;
    Random random(24);
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::ellipsoid, ShapeKind::box,
                                 ShapeKind::solid_cone, ShapeKind::solid_cylinder}) {
        for (int round = 0; round < 40; ++round) {
            const double size = std::pow(10.0, uniform(random, -3, 3));
            const glm::dvec3 center(
                glm::vec3(size * std::pow(10.0, uniform(random, -1, 3)) * unit_vector(random)));
            Scene scene;
            std::uint32_t group = 0;
            if (round % 2 == 1) group = oracle::add_group(scene);
            Target target = add_random_shape(scene, random, kind, center, size, round % 4 < 2);
            scene.primitives.back().sides = round % 3 == 0 ? Sides::back : Sides::both;
            if (round % 2 == 1) {
                glm::dmat4 placement(random_linear(random));
                placement[3] = glm::dvec4(center, 1);
                oracle::add_instance(scene, group, placement);
                target = placed(target, placement, 1);
            }
            std::vector<TestRay> rays;
            for (int i = 0; i < 1000; ++i) {
                const auto& points = target.points;
                const glm::dvec3 aim = points[static_cast<std::size_t>(i) % points.size()].position;
                const glm::vec3 from(target.center +
                                     uniform(random, 0, 0.3) * (points[0].position - target.center));
                const glm::dvec3 straight = aim - glm::dvec3(from);
                rays.push_back({from, glm::vec3(i % 3 == 0 ? unit_vector(random) : straight)});
            }
            CAPTURE(static_cast<int>(kind), round, size);
            CHECK(misses(tracer, tracer.upload(scene), rays) == 0);
        }
    }
}

TEST_CASE("a mesh with a hole leaks") {
    RayTracer tracer;
    Random random(22);
    ClosedMesh mesh = icosphere(random, 3, 1, 0.2, glm::dvec3(0));
    mesh.faces.pop_back();
    CHECK(leaks(tracer, random, mesh, 100'000) > 10);
}

}  // namespace sahl::tests
