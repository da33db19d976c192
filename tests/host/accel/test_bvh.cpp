#include "engine/accel/bvh.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/accel/wide_collapse.h"
#include "engine/core/error.h"
#include "tests/host/accel/boxes.h"
#include "tests/host/accel/tree_walk.h"

using namespace sahl;
using namespace sahl::test;

namespace {

void check_tree(const std::vector<BuildPrimitive>& primitives) {
    const Bvh bvh = build_bvh(primitives);
    const TreeFacts facts = walk(bvh, primitives);
    CHECK(facts.fault == "");
    CHECK(facts.stack_need <= SAHL_STACK_SIZE);
    CHECK(bvh.statistics.primitives == primitives.size());
    CHECK(bvh.statistics.nodes == bvh.nodes.size());
    CHECK(bvh.statistics.leaves == bvh.leaves.size());
    std::size_t references = 0;
    for (const BvhLeaf& leaf : bvh.leaves) references += leaf.count;
    CHECK(bvh.statistics.references == references);
    CHECK(bvh.statistics.leaf_fill ==
          Approx(static_cast<double>(references) / static_cast<double>(bvh.leaves.size())));
    CHECK(bvh.statistics.depth == facts.depth);
    CHECK(bvh.statistics.sah_cost == Approx(facts.sah_cost).epsilon(1e-9));
}

}  // namespace

TEST_CASE("trees of every kind of set hold each primitive once in exact boxes", "[bvh]") {
    for (const Spread spread : all_spreads) {
        for (const bool mixed : {false, true}) {
            for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 8u, 9u, 63u, 1000u, 20000u}) {
                CAPTURE(static_cast<int>(spread), mixed, size);
                check_tree(make_primitives(spread, size, mixed, static_cast<std::uint32_t>(size)));
            }
        }
    }
}

TEST_CASE("small trees of many seeds hold each primitive once in exact boxes", "[bvh]") {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        CAPTURE(seed);
        check_tree(make_primitives(Spread::uniform, seed % 40 + 1, seed % 2 != 0, seed));
    }
}

TEST_CASE("large trees, built by several threads, hold each primitive once in exact boxes", "[bvh]") {
    for (const Spread spread : {Spread::uniform, Spread::clustered, Spread::same_box, Spread::series}) {
        CAPTURE(static_cast<int>(spread));
        check_tree(make_primitives(spread, 150000, spread != Spread::uniform, 5));
    }
}

TEST_CASE("the tree of nothing is a root with empty slots", "[bvh]") {
    const Bvh bvh = build_bvh({});
    REQUIRE(bvh.nodes.size() == 1);
    for (std::size_t slot = 0; slot < 8; ++slot) {
        CHECK(bvh.nodes[0].child[slot] == 0xffffffffu);
        CHECK(bvh.nodes[0].lo_x[slot] == INFINITY);
        CHECK(bvh.nodes[0].lo_y[slot] == INFINITY);
        CHECK(bvh.nodes[0].lo_z[slot] == INFINITY);
        CHECK(bvh.nodes[0].hi_x[slot] == -INFINITY);
        CHECK(bvh.nodes[0].hi_y[slot] == -INFINITY);
        CHECK(bvh.nodes[0].hi_z[slot] == -INFINITY);
    }
    CHECK(bvh.leaves.empty());
    CHECK(bvh.leaf_lines == 0);
    CHECK(bvh.statistics.depth == 1);
    CHECK(bvh.statistics.sah_cost == 1);
}

TEST_CASE("up to four primitives of a kind are one leaf", "[bvh]") {
    for (const std::size_t size : {1u, 2u, 3u, 4u}) {
        const Bvh bvh = build_bvh(make_primitives(Spread::uniform, size, false, 1));
        REQUIRE(bvh.nodes.size() == 1);
        REQUIRE(bvh.leaves.size() == 1);
        CHECK(bvh.leaves[0].count == size);
        CHECK(bvh.statistics.leaf_fill == static_cast<double>(size));
        CHECK(bvh.nodes[0].child[0] == SAHL_CHILD_LEAF);
        // A lone child's box is the root's: whatever slot it has, a ray pays one node and one block.
        CHECK(bvh.statistics.sah_cost == Approx(2));
    }
}

TEST_CASE("kinds do not share leaves even where their boxes coincide", "[bvh]") {
    std::vector<BuildPrimitive> primitives;
    for (std::uint32_t id = 0; id < 36; ++id) primitives.push_back({cube(0, 0, 0, 1), id % 9, id});
    const Bvh bvh = build_bvh(primitives);
    CHECK(walk(bvh, primitives).fault == "");
    // Four of each of nine kinds: split by kind, every block is full, each polygon and instance is alone.
    REQUIRE(bvh.leaves.size() == 15);
    CHECK(bvh.leaf_lines == 3 + 2 + 4 + 4 + 4 * 1 + 4 + 4 + 4);
}

TEST_CASE("coinciding boxes fill their blocks in the order of ids", "[bvh]") {
    const std::vector<BuildPrimitive> primitives = make_primitives(Spread::same_box, 4096, false, 9);
    const Bvh bvh = build_bvh(primitives);
    REQUIRE(bvh.leaves.size() == 1024);
    for (const BvhLeaf& leaf : bvh.leaves) {
        CHECK(leaf.ids[0] % 4 == 0);
        CHECK(leaf.ids[3] == leaf.ids[0] + 3);
    }
}

TEST_CASE("blocks take the lines of their structs", "[bvh]") {
    CHECK(block_lines(SAHL_KIND_TRIANGLE) == 3);
    CHECK(block_lines(SAHL_KIND_SPHERE) == 2);
    CHECK(block_lines(SAHL_KIND_ELLIPSOID) == 4);
    CHECK(block_lines(SAHL_KIND_CONE) == 4);
    CHECK(block_lines(SAHL_KIND_POLYGON) == 1);
    CHECK(block_lines(SAHL_KIND_SOLID_CONE) == 4);
    CHECK(block_lines(SAHL_KIND_DISC) == 4);
    CHECK(block_lines(SAHL_KIND_BOX) == 4);
    CHECK(block_lines(SAHL_KIND_INSTANCE) == 0);
}

TEST_CASE("a leaf buffer past what references can address is an error of the scene", "[bvh]") {
    CHECK(addressable_lines(1u << 27) == 1u << 27);
    try {
        addressable_lines((1u << 27) + 1);
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
    }
}

TEST_CASE("a primitive of unknown kind is refused", "[bvh]") {
    CHECK_THROWS_AS(build_bvh({{cube(0, 0, 0, 1), 9, 0}}), Error);
}

TEST_CASE("trees in one forest keep their leaves and children", "[bvh]") {
    const std::vector<BuildPrimitive> first = make_primitives(Spread::uniform, 300, true, 1);
    const std::vector<BuildPrimitive> second = make_primitives(Spread::uniform, 200, true, 2);
    Bvh forest = build_bvh(first);
    const Bvh alone = build_bvh(second);
    const std::uint32_t nodes = static_cast<std::uint32_t>(forest.nodes.size()), lines = forest.leaf_lines;
    REQUIRE(append_tree(forest, alone) == nodes);
    CHECK(forest.leaf_lines == lines + alone.leaf_lines);
    // Moved back, the second tree is whole.
    Bvh moved_back = alone;
    std::copy(forest.nodes.begin() + nodes, forest.nodes.end(), moved_back.nodes.begin());
    std::copy(forest.leaves.end() - static_cast<std::ptrdiff_t>(alone.leaves.size()), forest.leaves.end(),
              moved_back.leaves.begin());
    for (device::BvhNode& node : moved_back.nodes) {
        for (int slot = 0; slot < 8; ++slot) {
            if (node.lo_x[slot] > node.hi_x[slot]) continue;
            const bool leaf = (node.child[slot] & SAHL_CHILD_LEAF) != 0;
            if (leaf && (node.child[slot] >> 27 & 15u) == SAHL_KIND_INSTANCE) continue;
            node.child[slot] -= leaf ? lines : nodes;
        }
    }
    CHECK(walk(moved_back, second).fault == "");
    CHECK(walk(alone, second).fault == "");
}
