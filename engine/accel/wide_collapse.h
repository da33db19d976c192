// Binary tree to 8-wide tree.
#pragma once

#include <cstdint>
#include <span>

#include "engine/accel/binary_tree.h"
#include "engine/accel/bvh.h"

namespace sahl {

/// A node whose slots are all empty.
device::BvhNode empty_node();

/// The line offset after a block of `kind` at `offset`.
/// Throws Error(scene) if it is past the 2^28 lines that a child reference can address.
std::uint32_t offset_after_block(std::uint32_t offset, std::uint32_t kind);

/// Appends the wide nodes and leaves of `tree` over `primitives` (at least one, in the tree's
/// order) to the empty `bvh`, which gets its leaf_lines as well. A node starts as the two children
/// of a binary node; the inner child of largest area is replaced by its own two until there are
/// eight or only leaves.
/// Source: Wald, Benthin, Boulos 2008, "Getting Rid of Packets", sec. 3 (collapse by area).
void collapse(const BinaryTree& tree, std::span<const BuildPrimitive> primitives, Bvh& bvh);

}  // namespace sahl
