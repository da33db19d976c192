// Where to split a set of primitives: binned surface area heuristic.
// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies", sec. 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/accel/bvh.h"
#include "engine/accel/cost_model.h"
#include "engine/accel/vector_box.h"

namespace sahl {

/// Sets at least this large are summed and partitioned by several threads.
inline constexpr std::size_t parallel_set_size = 1u << 16;

struct SetSummary {
    VectorBox box;
    VectorBox centroids;  ///< of lo + hi, twice the centroid
    KindCounts counts{};
};

/// Equal bins along each axis, over the range of lo + hi.
struct Grid {
    Float4 origin{};
    Float4 scale{};  ///< bins per unit of lo + hi; 0 along an axis without extent
    std::int32_t bins = 1;

    /// The bins of a primitive along x, y and z.
    Int4 bins_of(const BuildPrimitive& primitive) const {
        const Float4 place = (load_lo(primitive) + load_hi(primitive) - origin) * scale;
        const Int4 bin = __builtin_convertvector(place, Int4);
        const Int4 last = Int4{} + (bins - 1);
        return bin < last ? bin : last;
    }
};

/// A way to cut a set in two: what is in bins (along x, y, z for axis 0..2) or of a kind (axis 3)
/// less than `position` goes left.
struct Split {
    static constexpr int by_kind = 3;
    Grid grid;
    int axis = 0;
    std::int32_t position = 0;
    double cost = std::numeric_limits<double>::infinity();
    std::size_t larger_side = 0;  ///< primitives of the larger side

    bool found() const { return position > 0; }
    bool goes_left(const BuildPrimitive& primitive) const {
        if (axis == by_kind) return static_cast<std::int32_t>(primitive.kind) < position;
        return grid.bins_of(primitive)[axis] < position;
    }
};

SetSummary summarise(std::span<const BuildPrimitive> primitives);

/// The split of least area x blocks_cost() summed over both sides, among those of at most
/// `max_side` primitives a side; none found if there is no such split. Independent of the order
/// of the primitives and of the threads.
Split find_split(std::span<const BuildPrimitive> primitives, const SetSummary& summary, std::size_t max_side);

}  // namespace sahl
