// Where to split a set of primitives so that each goes to one side: binned surface area heuristic.
// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies", sec. 3.
#pragma once

#include <cstddef>
#include <span>

#include "engine/accel/bvh.h"
#include "engine/accel/set_summary.h"
#include "engine/accel/split_sweep.h"
#include "engine/accel/vector_box.h"

namespace sahl {

/// A way to part a set by place (along x, y, z for axis 0..2, of lo + hi) or by kind (axis 3).
struct ObjectSplit {
    static constexpr int by_kind = 3;
    Grid grid;
    Border border;
    VectorBox left;
    VectorBox right;

    bool found() const { return border.found(); }
    /// Which primitives go left, for a split along x, y or z: the same as bins less than the border's
    /// position.
    auto goes_left() const {
        return [axis = border.axis, origin = grid.origin[border.axis], scale = grid.scale[border.axis],
                end = static_cast<float>(border.position)](const BuildPrimitive& primitive) {
            const auto& [lo, hi] = primitive.bounds;
            return (lo[axis] + hi[axis] - origin) * scale < end;
        };
    }
};

/// The split of least area x blocks_cost() summed over both sides, among those of at most
/// `max_side` primitives a side; none found if there is no such split. Fast: along the axis on which
/// centroids lie farthest apart alone. Independent of the order of the primitives and of the threads.
ObjectSplit find_object_split(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                              std::size_t max_side, BuildQuality quality);

}  // namespace sahl
