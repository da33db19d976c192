// Which child sits in which of a node's eight slots, so that traversal sorts nothing.
#pragma once

#include <array>
#include <span>

#include "engine/accel/bounds.h"

namespace sahl {

/// Gives each of up to eight boxes a slot of its own: a ray whose direction has the signs
/// `octant` (bit k set: component k negative) then meets the boxes about front to back when it
/// visits the slots 0 ^ octant, 1 ^ octant, ... 7 ^ octant. Boxes in the corners of their common
/// box get the slot whose bit k is set on the far side of axis k.
/// Returns slot by box; entries past the boxes are the slots left over.
/// Source: Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", sec. 3.2 (their cost; greedy instead of their auction).
std::array<int, 8> assign_slots(std::span<const Bounds> boxes);

}  // namespace sahl
