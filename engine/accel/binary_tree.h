// The binary tree that the wide one is collapsed from: a split for every set of primitives that
// is no leaf.
//
// Memory, measured by bench/run build: from the boxes of triangles to wide nodes and packed leaf blocks the
// process grows by 54 to 132 bytes a triangle at its peak, most of it references and leaf blocks;
// scene_memory.h has the bound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/accel/collapse_plan.h"

namespace sahl {

/// A leaf: at most SAHL_BLOCK_WIDTH references of one kind, side by side.
struct BinaryLeaf {
    std::uint32_t begin;
    std::uint32_t size;
};

/// Marks a child that is a leaf. Other children are indices of nodes.
inline constexpr std::uint32_t binary_leaf = 0x80000000u;
static_assert(most_references(SAHL_MAX_PRIMITIVES) <= 1u << 28 && SAHL_BLOCK_WIDTH <= 8);
constexpr std::uint32_t pack_leaf(const BinaryLeaf& leaf) {
    return binary_leaf | (leaf.size - 1) << 28 | leaf.begin;
}
constexpr BinaryLeaf unpack_leaf(std::uint32_t child) {
    return {child & 0x0fffffffu, (child >> 28 & 7u) + 1};
}

/// What the leaves of a subtree are: so many, with so many lines of blocks.
struct LeafExtent {
    std::uint32_t leaves;
    std::uint32_t lines;
};

/// The inner node of a set. That of a large set has as index where the references of its right child begin;
/// those of a small one's subtree lie side by side from behind the index where its references begin, so that
/// few pages are touched. Indices are unique, so nodes built by different threads find their places without a
/// shared counter and are the same in every run. No defaulted members: most of the array is never touched.
struct BinaryNode {
    Bounds bounds;
    std::uint32_t left;
    std::uint32_t right;
    CutPlan plan;
    LeafExtent below;
    std::uint32_t wide_children;  ///< for collapse(), of those that become wide nodes
    std::uint32_t wide_nodes;     ///< the same: there are so many in the subtree
};

/// What a parent must know of a subtree.
struct BinarySubtree {
    std::uint32_t root = binary_leaf;
    ForestCosts costs{};
    LeafExtent below{};
};
static_assert(std::is_trivially_default_constructible_v<BinaryNode>);

/// `visits`: of the leaf by a ray that meets the tree's root, on average.
BinarySubtree leaf_subtree(const BinaryLeaf& leaf, std::uint32_t kind, float visits);

struct BinaryTree {
    std::vector<BuildPrimitive> references;  ///< a primitive may have several, of parts of it
    std::unique_ptr<BinaryNode[]> nodes;     ///< as many as references; unused ones are not set
    std::uint32_t root = binary_leaf;
    Bounds bounds{};

    /// Sets node `index`. `visits` as for leaf_subtree().
    BinarySubtree join(std::uint32_t index, const Bounds& box, float visits, const BinarySubtree& left,
                       const BinarySubtree& right);
};

/// Builds the tree over `primitives` (at least one). No path has more than SAHL_MAX_TREE_DEPTH splits.
/// References are most_references(primitives) at most; triangles are cut if `corners` are given. Throws
/// Error(internal) if a kind is unknown.
BinaryTree build_binary_tree(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners,
                             BuildQuality quality);

}  // namespace sahl
