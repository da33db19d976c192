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
    for (std::uint32_t id = 0; id < 20; ++id) primitives.push_back({cube(0, 0, 0, 1), id % 5, id});
    const Bvh bvh = build_bvh(primitives);
    CHECK(walk(bvh, primitives).fault == "");
    // Four of each of five kinds: split by kind, every block is full.
    REQUIRE(bvh.leaves.size() == 5);
    CHECK(bvh.leaf_lines == 3 + 2 + 4 + 4 + 3);
    CHECK(bvh.nodes.size() == 1);
    CHECK(bvh.statistics.sah_cost == Approx(1 + 1 + 1 + 1.5 + 1.5 + 2));
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
    CHECK(block_lines(SAHL_KIND_POLYGON) == 3);
}

TEST_CASE("a leaf buffer past what references can address is an error of the scene", "[bvh]") {
    CHECK(offset_after_block((1u << 28) - 3, SAHL_KIND_TRIANGLE) == 1u << 28);
    try {
        offset_after_block((1u << 28) - 2, SAHL_KIND_TRIANGLE);
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
    }
}

TEST_CASE("a primitive of unknown kind is refused", "[bvh]") {
    CHECK_THROWS_AS(build_bvh({{cube(0, 0, 0, 1), 5, 0}}), Error);
}
