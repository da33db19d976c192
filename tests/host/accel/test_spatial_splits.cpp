#include <algorithm>
#include <cstddef>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/accel/bvh.h"
#include "tests/host/accel/boxes.h"
#include "tests/host/accel/tree_walk.h"
#include "tests/host/accel/triangles.h"

using namespace sahl;
using namespace sahl::test;

namespace {

void check_tree(const TriangleSet& set, BuildQuality quality) {
    const Bvh bvh = build_bvh(set.primitives, set.corners(), quality);
    const TreeFacts facts = walk_parts(bvh, set);
    CHECK(facts.fault == "");
    CHECK(facts.stack_need <= SAHL_STACK_SIZE);
    CHECK(bvh.statistics.depth <= static_cast<int>(SAHL_MAX_TREE_DEPTH));
    CHECK(bvh.statistics.depth == facts.depth);
    CHECK(bvh.statistics.sah_cost == Approx(facts.sah_cost).epsilon(1e-9));
    CHECK(bvh.statistics.primitives == set.primitives.size());
    std::size_t references = 0;
    for (const BvhLeaf& leaf : bvh.leaves) references += leaf.count;
    CHECK(bvh.statistics.references == references);
    CHECK(references <= most_references(set.primitives.size()));
    CHECK(bvh.nodes.size() <= most_nodes(set.primitives.size()));
}

}  // namespace

TEST_CASE("spatial splits: every point of every triangle is in a leaf that has it", "[bvh]") {
    for (const Triangles kind : all_triangles) {
        for (const std::size_t size : {1U, 2U, 4U, 5U, 9U, 40U, 500U, 3000U}) {
            for (std::uint32_t seed = 0; seed < (size < 100 ? 20U : 1U); ++seed) {
                CAPTURE(static_cast<int>(kind), size, seed);
                const TriangleSet set = make_triangles(kind, size, seed);
                check_tree(set, BuildQuality::high);
                check_tree(set, BuildQuality::fast);
            }
        }
    }
}

TEST_CASE("spatial splits: large sets, cut by several threads, are whole", "[bvh]") {
    check_tree(make_triangles(Triangles::crossed, 80000, 3), BuildQuality::high);
    check_tree(make_triangles(Triangles::giant, 80000, 3), BuildQuality::high);
    check_tree(make_triangles(Triangles::beams, 80000, 3), BuildQuality::fast);
}

TEST_CASE("spatial splits: triangles among other kinds are cut, the others are whole", "[bvh]") {
    TriangleSet set = make_triangles(Triangles::crossed, 2000, 5);
    std::mt19937 random(6);
    for (std::uint32_t i = 0; i < 500; ++i) {
        const Bounds box = cube(uniform(random), uniform(random), uniform(random), 0.5F * uniform(random));
        const std::uint32_t kind = 1 + i % 8;
        set.lowered.push_back({kind, 0, 0, 0});
        set.primitives.push_back({box, kind, 2000 + i});
    }
    const Bvh bvh = build_bvh(set.primitives, set.corners());
    CHECK(walk_parts(bvh, set).fault == "");
    CHECK(bvh.statistics.references > 2100);
    for (const BvhLeaf& leaf : bvh.leaves) {
        if (leaf.kind == SAHL_KIND_INSTANCE) CHECK(leaf.count == 1);
    }
}

TEST_CASE("spatial splits: long triangles across small ones cost less cut than whole", "[bvh]") {
    for (const std::size_t size : {300U, 3000U, 20000U}) {
        const TriangleSet set = make_triangles(Triangles::beams, size, 1);
        const double whole = build_bvh(set.primitives).statistics.sah_cost;
        const BvhStatistics cut = build_bvh(set.primitives, set.corners()).statistics;
        CAPTURE(size, whole, cut.sah_cost);
        CHECK(cut.sah_cost < 0.9 * whole);
        CHECK(cut.references > size);
    }
}

TEST_CASE("spatial splits: small triangles that do not overlap stay whole", "[bvh]") {
    // A field of squares, two triangles each, apart from each other.
    TriangleSet set;
    for (std::uint32_t id = 0; id < 5000; ++id) {
        const auto x = static_cast<float>(id / 2 % 50), z = static_cast<float>(id / 2 / 50);
        const float far = id % 2 == 0 ? 0.0F : 0.5F;
        const float corners[] = {x + 0.5F, 0, z, x, 0, z + 0.5F, x + far, 0, z + far};
        set.data.insert(set.data.end(), std::begin(corners), std::end(corners));
        set.lowered.push_back({SAHL_KIND_TRIANGLE, 0, 9 * id, 0});
        set.primitives.push_back({{{x, 0, z}, {x + 0.5F, 0, z + 0.5F}}, SAHL_KIND_TRIANGLE, id});
    }
    CHECK(build_bvh(set.primitives, set.corners()).statistics.references == 5000);
}

TEST_CASE("spatial splits: a tree built fast costs at most a quarter more", "[bvh]") {
    for (const Triangles kind : {Triangles::small, Triangles::beams, Triangles::giant}) {
        const TriangleSet set = make_triangles(kind, 30000, 2);
        const auto cost = [&](BuildQuality quality) {
            return build_bvh(set.primitives, set.corners(), quality).statistics.sah_cost;
        };
        CAPTURE(static_cast<int>(kind));
        CHECK(cost(BuildQuality::fast) <= 1.25 * cost(BuildQuality::high));
    }
}
