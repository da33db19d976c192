// Binary tree to 8-wide tree.
#pragma once

#include <cstdint>

#include "engine/accel/binary_tree.h"
#include "engine/accel/bvh.h"

namespace sahl {

/// A tree over nothing: a node whose slots are all empty.
Bvh empty_bvh();

/// `lines` of 64 bytes as the size of a leaf buffer.
/// Throws Error(scene) if they are more than the 2^27 that a child reference can address.
std::uint32_t addressable_lines(std::uint64_t lines);

/// The wide tree of `tree`: the children of a node are the cut that its plan says is best. Uses the extents
/// in `tree`. The statistics lack the number of primitives and the time. Throws as addressable_lines.
Bvh collapse(BinaryTree& tree);

}  // namespace sahl
