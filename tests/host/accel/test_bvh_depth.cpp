#include "engine/accel/binary_tree.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/host/accel/boxes.h"

using namespace sahl;
using namespace sahl::test;

namespace {

std::uint32_t depth_of(const BinaryTree& tree, std::uint32_t node) {
    if ((node & binary_leaf) != 0) return 0;
    return 1 + std::max(depth_of(tree, tree.nodes[node].left), depth_of(tree, tree.nodes[node].right));
}

std::uint32_t binary_depth(std::vector<BuildPrimitive> primitives) {
    const BinaryTree tree = build_binary_tree(std::move(primitives), {}, BuildQuality::high);
    return depth_of(tree, tree.root);
}

}  // namespace

TEST_CASE("no set makes the binary tree deeper than its bound", "[bvh]") {
    for (const Spread spread : all_spreads) {
        if (spread == Spread::negative_zeros) continue;
        for (const bool mixed : {false, true}) {
            for (const std::size_t size : {66u, 300u, 5000u, 100000u}) {
                CAPTURE(static_cast<int>(spread), mixed, size);
                CHECK(binary_depth(make_primitives(spread, size, mixed, 3)) <= SAHL_MAX_TREE_DEPTH);
            }
        }
    }
}

TEST_CASE("a series of shrinking cubes uses the depth up to the bound", "[bvh]") {
    // Cubes at 22 places along each axis, each place far from all that follow: without the bound they
    // are peeled off place by place. What is left at the bottom needs balanced splits, and has
    // room for them.
    CHECK(binary_depth(make_primitives(Spread::series, 100000, true, 3)) == SAHL_MAX_TREE_DEPTH);
}

TEST_CASE("trees over uniform sets are shallow", "[bvh]") {
    // 2^16 primitives are 2^14 full blocks.
    const std::uint32_t depth = binary_depth(make_primitives(Spread::uniform, 1u << 16, false, 3));
    CHECK(depth >= 14);
    CHECK(depth <= 21);
}
