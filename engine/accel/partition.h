// Cutting a set of primitives in two, by one thread or several.
#pragma once

#include <cstddef>
#include <span>

#include "engine/accel/binned_sah.h"
#include "engine/accel/bvh.h"

namespace sahl {

/// Moves the primitives that go left to the front and returns how many they are. `scratch` is as
/// long as `primitives` if these are parallel_set_size or more, and not used otherwise. The
/// resulting order depends on the order before alone.
std::size_t partition(std::span<BuildPrimitive> primitives, std::span<BuildPrimitive> scratch,
                      const Split& split);

/// The same by rank instead of place: the `left_size` primitives with the least centroids along
/// `axis` go to the front, equal ones in the order of their ids.
void partition_by_rank(std::span<BuildPrimitive> primitives, int axis, std::size_t left_size);

}  // namespace sahl
