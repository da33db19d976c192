// kernels/traverse_*.h and bvh.h: the tree finds what offering every ray every leaf finds, bit for bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/oracle/build_scene.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {

TEST_CASE("the tree finds what a search of all leaves finds, bit for bit") {
    RayTracer tracer;
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
            CHECK(differences(rays, hits, tracer.brute_force(scene, rays)) == "");
            // Something was hit.
            CHECK(std::count_if(hits.begin(), hits.end(), [](const TestHit& hit) { return hit.hit(); }) >
                  20000);
        }
    }
}

namespace {

/// A chain of nodes from `first` on, the longest there can be: each has seven leaves that every ray enters
/// and, in the slot that rays of `octant` visit first, the next node; `last` ends the chain.
void add_chain(std::vector<device::BvhNode>& nodes, std::uint32_t octant, std::uint32_t last) {
    // The scene's only leaf is at offset 0.
    const std::uint32_t leaf = SAHL_CHILD_LEAF | SAHL_KIND_TRIANGLE << SAHL_CHILD_KIND_SHIFT;
    for (std::uint32_t level = 0; level <= SAHL_MAX_TREE_DEPTH; ++level) {
        device::BvhNode node{};
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = -3;
            node.hi_x[slot] = node.hi_y[slot] = node.hi_z[slot] = 3;
            node.child[slot] = leaf;
        }
        const auto next = static_cast<std::uint32_t>(nodes.size()) + 1;
        node.child[octant] = level < SAHL_MAX_TREE_DEPTH ? next : last;
        nodes.push_back(node);
    }
}

/// The identity, for a group whose tree begins at `root`.
device::DeviceInstance instance_at(std::uint32_t root) {
    device::DeviceInstance instance{};
    for (std::size_t k = 0; k < 3; ++k) instance.rows[k][k] = 1;
    instance.root = root;
    instance.extent = 3;
    return instance;
}

}  // namespace

TEST_CASE("the deepest trees there can be, one in the other, fit the stack") {
    RayTracer tracer;
    Scene scene;
    Material glass;
    glass.transmission = glm::vec3(0.5F);
    for (int i = 0; i < 4; ++i) oracle::add_triangle(scene, {{-2, -2, 1}, {2, -2, 1}, {0, 3, 1}}, glass);
    scene.lights = {oracle::point_light({0.25, 0.125, 3})};
    DeviceScene device_scene = tracer.upload(scene);
    const std::uint32_t leaf = SAHL_CHILD_LEAF | SAHL_KIND_TRIANGLE << SAHL_CHILD_KIND_SHIFT;
    const std::uint32_t instance = SAHL_CHILD_LEAF | SAHL_KIND_INSTANCE << SAHL_CHILD_KIND_SHIFT;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        CAPTURE(octant);
        const auto sign = [&](std::uint32_t axis) { return (octant >> axis & 1U) != 0 ? -1.0F : 1.0F; };
        const TestRay ray{{0, 0, 1 - sign(2)}, {1e-3F * sign(0), 1e-3F * sign(1), sign(2)}};
        std::vector<TestRay> rays(80, ray);
        // Rays of other octants among them, for packets to sort out.
        for (std::uint32_t i = 0; i < 40; ++i) {
            for (std::uint32_t k = 0; k < 2; ++k)
                rays[2 * i].direction[static_cast<int>(k)] *= (i >> k & 1U) != 0 ? -1.0F : 1.0F;
        }
        for (const bool nested : {false, true}) {
            CAPTURE(nested);
            std::vector<device::BvhNode> nodes;
            add_chain(nodes, octant, nested ? instance : leaf);
            if (nested) {
                device_scene.instances =
                    tracer.upload_instances({instance_at(static_cast<std::uint32_t>(nodes.size()))});
                add_chain(nodes, octant, leaf);
            }
            device_scene.nodes = tracer.upload_nodes(nodes);
            for (const TestHit& hit : tracer.intersect(device_scene, rays))
                REQUIRE((hit.primitive == 0 && hit.instance == SAHL_WORLD && hit.t == 1));
            if (octant != 0) continue;
            // All four triangles, of the world and of the instance, are between the points and the light.
            const std::vector<TestLitPoint> points(40, {{0.25F, 0.125F, 0}});
            const float passed = nested ? 0x1p-8F : 0x1p-4F;
            for (const glm::vec3& light :
                 tracer.arriving(device_scene, points, std::vector(40, glm::vec3(1))))
                REQUIRE(light == glm::vec3(passed));
        }
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
    CHECK(differences(rays, tracer.intersect(scene, rays), tracer.brute_force(scene, rays)) == "");
}

}  // namespace sahl::tests
