// Where to split a set in space: what lies on both sides of a plane is cut in two, and both sides refer to
// the triangle. Long triangles that lie across each other have no other good split.
// Source: Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies".
#pragma once

#include <cstddef>
#include <span>

#include "engine/accel/binned_sah.h"
#include "engine/accel/bvh.h"
#include "engine/accel/partition.h"
#include "engine/accel/split_sweep.h"

namespace sahl {

/// A plane between bins over a set's box.
struct SpatialSplit {
    Grid grid;
    Border border;
    VectorBox left;   ///< of what is left of the plane
    VectorBox right;  ///< and right of it

    bool found() const { return border.found(); }
};

/// The split of least area x blocks_cost() summed over both sides, among those of at most `max_side`
/// references a side and `max_together` on both; none found if there is no such split, or if the set's box is
/// too thin or too large to be cut exactly. Triangles are cut, all others go to the side of their centre.
/// Independent of the order of the references and of the threads.
SpatialSplit find_spatial_split(std::span<const BuildPrimitive> references, const TriangleCorners& corners,
                                const SetSummary& summary, std::size_t max_side, std::size_t max_together);

/// Parts the first `size` of `references`, those on the left first, then those on the right. What lies across
/// becomes two references, one of them in the room behind, where that costs less than to leave it whole on
/// one side (Stich, sec. 4.4). No side is larger than the split says, but one may be empty.
Parted apply(const SpatialSplit& split, std::span<BuildPrimitive> references, std::size_t size,
             const TriangleCorners& corners);

}  // namespace sahl
