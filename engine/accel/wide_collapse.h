// Binary tree to 8-wide tree.
#pragma once

#include <cstdint>

#include "engine/accel/binary_tree.h"
#include "engine/accel/bvh.h"

namespace sahl {

/// A node whose slots are all empty.
device::BvhNode empty_node();

/// `lines` of 64 bytes as the size of a leaf buffer.
/// Throws Error(scene) if they are more than the 2^27 that a child reference can address.
std::uint32_t addressable_lines(std::uint64_t lines);

/// Sets the wide nodes and leaves of `tree`, and leaf_lines, in `bvh`: the children of a node are the cut
/// that its plan says is best. Uses the extents in `tree`. Throws as addressable_lines.
void collapse(BinaryTree& tree, Bvh& bvh);

}  // namespace sahl
