// The binary tree that the wide one is collapsed from: a split for every set of primitives that
// is no leaf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/accel/bvh.h"

namespace sahl {

/// Stands for a set that is a leaf: at most SAHL_BLOCK_WIDTH primitives of one kind.
inline constexpr std::uint32_t binary_leaf = 0xffffffffu;

/// The inner node of a set. Its index m is its split: of the primitives [begin, end) its left
/// child has [begin, m), its right one [m, end). Splits are unique, so nodes built by different
/// threads find their places without a shared counter and are the same in every run.
/// No defaulted members: most of the array is never touched.
struct BinaryNode {
    Bounds bounds;
    std::uint32_t left;
    std::uint32_t right;
};

struct BinaryTree {
    std::unique_ptr<BinaryNode[]> nodes;  ///< as many as primitives; unused ones are not set
    std::uint32_t root = binary_leaf;
};

/// Orders `primitives` (at least one) and builds the tree over them. No path has more than
/// SAHL_MAX_TREE_DEPTH splits. Bounds must have no negative zeros.
BinaryTree build_binary_tree(std::span<BuildPrimitive> primitives);

}  // namespace sahl
