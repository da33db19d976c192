// The binary tree that the wide one is collapsed from: a split for every set of primitives that
// is no leaf.
//
// Memory, measured by bench/run build: from the boxes of triangles to wide nodes and packed leaf blocks the
// process grows by 105 to 185 bytes a triangle at its peak, most of it references and binary nodes;
// scene_memory.h has the bound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/accel/collapse_plan.h"

namespace sahl {

/// Marks a child that is a leaf, in the lower bits the size of its set: at most SAHL_BLOCK_WIDTH primitives
/// of one kind. Other children are indices of nodes.
inline constexpr std::uint32_t binary_leaf = 0x80000000u;

/// How much a wide tree is: children of its root; nodes, leaves and lines of leaves' blocks in all.
struct WideExtent {
    std::uint32_t children;
    std::uint32_t nodes;
    std::uint32_t leaves;
    std::uint32_t lines;
};

/// The inner node of a set. Its index is where the references of its right child begin; those of its left
/// child begin where its own do. Indices are unique, so nodes built by different threads find their places
/// without a shared counter and are the same in every run. No defaulted members: most of the array is never
/// touched.
struct BinaryNode {
    Bounds bounds;
    std::uint32_t left;
    std::uint32_t right;
    CutPlan plan;
    WideExtent extent;  ///< for collapse(), of those that become wide nodes
};

struct BinaryTree {
    std::vector<BuildPrimitive> references;  ///< a primitive may have several, of parts of it
    std::unique_ptr<BinaryNode[]> nodes;     ///< as many as references; unused ones are not set
    std::uint32_t root = binary_leaf;
    Bounds bounds{};
};

/// Builds the tree over `primitives` (at least one). No path has more than SAHL_MAX_TREE_DEPTH splits.
/// Bounds must have no negative zeros. References are most_references(primitives) at most; triangles are cut
/// in space if `corners` are given.
BinaryTree build_binary_tree(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners,
                             BuildQuality quality);

}  // namespace sahl
