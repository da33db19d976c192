// No ray slips between faces that share vertices.
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/device/closed_meshes.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

/// Rays among `total` at the mesh that do not hit it.
int leaks(RayTracer& tracer, Random& random, const ClosedMesh& mesh, std::size_t total) {
    constexpr std::size_t batch = 1U << 16U;
    const DeviceScene scene = tracer.upload(mesh.scene());
    int count = 0;
    for (std::size_t done = 0; done < total; done += batch) {
        const std::vector<TestRay> rays = rays_at(random, mesh, batch);
        const std::vector<TestHit> hits = tracer.intersect(scene, rays);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (hits[i].hit() && hits[i].t > 0) continue;
            if (++count > 3) continue;
            const TestRay& ray = rays[i];
            UNSCOPED_INFO("kind " << i % 4 << " from " << ray.origin.x << " " << ray.origin.y << " "
                                  << ray.origin.z << " along " << ray.direction.x << " " << ray.direction.y
                                  << " " << ray.direction.z);
        }
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
    // 1 million rays, or 24 million, in all.
    const std::size_t rays = (full_tests() ? 24'000'000U : 1'000'000U) / meshes.size();
    for (const auto& [name, mesh] : meshes) {
        CAPTURE(name);
        CHECK(leaks(tracer, random, mesh, rays) == 0);
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
