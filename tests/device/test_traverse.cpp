// kernels/traverse_scalar.h and bvh.h: the tree finds what offering every ray every leaf finds, bit for bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iomanip>
#include <vector>

#include "engine/oracle/build_scene.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

/// Rays whose hit through the tree is not bit for bit the one without it.
int differences(const std::vector<TestRay>& rays, const std::vector<TestHit>& a,
                const std::vector<TestHit>& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] == b[i]) continue;
        if (++count > 4) continue;
        const TestRay& ray = rays[i];
        UNSCOPED_INFO(std::setprecision(9)
                      << "ray " << i << " from " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
                      << " along " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z
                      << ": " << a[i].primitive << " at " << a[i].t << ", " << b[i].primitive << " at "
                      << b[i].t);
    }
    return count;
}

}  // namespace

TEST_CASE("the tree finds what a search of all leaves finds, and plain OpenCL the same, bit for bit") {
    RayTracer tracer, plain("-DSAHL_PLAIN_OPENCL");
    Random random(11);
    const std::size_t batches = full_tests() ? 64 : 4;
    for (std::size_t batch = 0; batch < batches; ++batch) {
        std::vector<Soup> soups;
        soups.push_back(random_soup(random, 48, 1, 0));
        soups.push_back(random_soup(random, 48, 1e3, 1e5));
        soups.push_back(random_soup(random, 48, 1e-3, 1e-2));
        soups.push_back(axis_parallel_soup(random, 40));
        for (const Soup& soup : soups) {
            DeviceScene scene = tracer.upload(soup.scene);
            const std::vector<TestRay> rays = random_rays(random, soup, 1U << 16U);
            const std::vector<TestHit> hits = tracer.intersect(scene, rays);
            CHECK(differences(rays, hits, tracer.brute_force(scene, rays)) == 0);
            CHECK(differences(rays, hits, plain.intersect(plain.upload(soup.scene), rays)) == 0);
            // Something was hit.
            CHECK(std::count_if(hits.begin(), hits.end(), [](const TestHit& hit) { return hit.hit(); }) >
                  20000);
        }
    }
}

TEST_CASE("the deepest tree there can be fits the stack") {
    // Each node of a chain: seven leaves that every ray enters, and the next node, which is visited first.
    RayTracer tracer;
    Scene scene;
    for (int i = 0; i < 4; ++i) oracle::add_triangle(scene, {{-2, -2, 1}, {2, -2, 1}, {0, 3, 1}}, {});
    DeviceScene device_scene = tracer.upload(scene);
    for (const int octant : {0, 7}) {
        std::vector<device::BvhNode> chain(SAHL_MAX_TREE_DEPTH + 1);
        for (std::uint32_t level = 0; level < chain.size(); ++level) {
            device::BvhNode& node = chain[level];
            for (int slot = 0; slot < 8; ++slot) {
                node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = -3;
                node.hi_x[slot] = node.hi_y[slot] = node.hi_z[slot] = 3;
                const bool goes_on = slot == octant && level + 1 < chain.size();
                // The scene's only leaf is at offset 0.
                node.child[slot] =
                    goes_on ? level + 1 : SAHL_CHILD_LEAF | SAHL_KIND_TRIANGLE << SAHL_CHILD_KIND_SHIFT;
            }
        }
        device_scene.nodes = tracer.upload_nodes(chain);
        const float sign = octant == 0 ? 1.0F : -1.0F;
        const std::vector<TestRay> rays(200, {{0, 0, 1 - sign}, sign * glm::vec3(1e-3F, 1e-3F, 1)});
        for (const TestHit& hit : tracer.intersect(device_scene, rays))
            REQUIRE((hit.primitive == 0 && hit.t == 1));
    }
}

TEST_CASE("trees over sizes from 1e-6 to 1e6 find what a search of all leaves finds") {
    RayTracer tracer;
    Random random(14);
    Soup soup;
    for (int i = 0; i < 120; ++i) {
        const double size = std::pow(10.0, uniform(random, -6, 6));
        const glm::vec3 center(size * 3.0 * unit_vector(random));
        soup.targets.push_back(add_random_shape(soup.scene, random,
                                                static_cast<ShapeKind>(i % shape_kind_count),
                                                glm::dvec3(center), size, i % 2 == 0));
    }
    DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<TestRay> rays = random_rays(random, soup, 30000);
    CHECK(differences(rays, tracer.intersect(scene, rays), tracer.brute_force(scene, rays)) == 0);
}

}  // namespace sahl::tests
