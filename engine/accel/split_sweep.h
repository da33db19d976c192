// The surface area heuristic over bins: which border between them to split at. Bins are swept from both
// ends; each has a box and tells what of a set begins (`entries`) and ends (`exits`) in it.
// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies", sec. 3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/accel/cost_model.h"
#include "engine/accel/vector_box.h"

namespace sahl {

inline constexpr std::size_t most_bins = 32;

/// Equal bins along each axis.
struct Grid {
    Float4 origin{};
    Float4 scale{};  ///< bins per unit; 0 along an axis without extent
    Float4 width{};  ///< of a bin
    std::int32_t bins = 1;

    /// The bins along x, y and z of a point that is not below the origin.
    Int4 bins_at(Float4 point) const {
        const Int4 bin = __builtin_convertvector((point - origin) * scale, Int4);
        const Int4 last = Int4{} + (bins - 1);
        return bin < last ? bin : last;
    }
    /// The bin of a primitive's lo + hi along one axis: the same as bins_at() gives.
    std::int32_t bin_of(const BuildPrimitive& primitive, int axis) const {
        const float place = primitive.bounds.lo[axis] + primitive.bounds.hi[axis] - origin[axis];
        return std::min(static_cast<std::int32_t>(place * scale[axis]), bins - 1);
    }
    /// Where bin `i` begins, rounding apart.
    float border(int axis, std::int32_t i) const {
        return origin[axis] + static_cast<float>(i) * width[axis];
    }
};

inline Grid make_grid(const VectorBox& box, std::size_t bins) {
    Grid grid;
    grid.bins = static_cast<std::int32_t>(bins);
    grid.origin = box.lo;
    const Float4 extent = box.hi - box.lo;
    const Float4 count = Float4{} + static_cast<float>(bins);
    // Not for extents whose reciprocal overflows.
    grid.scale = extent > 1e-30F ? count / extent : Float4{};
    grid.width = extent / count;
    return grid;
}

/// How many primitives of a set of one kind.
struct OneKind {
    std::uint32_t count = 0;

    void add(std::uint32_t /*kind*/) { ++count; }
    void add(const OneKind& other) { count += other.count; }
    std::size_t size() const { return count; }
};

/// How many primitives of each kind.
struct AnyKind {
    KindCounts counts{};

    void add(std::uint32_t kind) { ++counts[kind]; }
    void add(const AnyKind& other) {
        for (std::size_t kind = 0; kind < kind_count; ++kind) counts[kind] += other.counts[kind];
    }
    std::size_t size() const {
        std::size_t size = 0;
        for (const std::uint32_t count : counts) size += count;
        return size;
    }
};

/// What it costs to test a part of a set.
struct Price {
    float scale;         ///< of lengths, so that areas neither under- nor overflow
    std::uint32_t kind;  ///< of OneKind

    static float scale_of(const VectorBox& set) {
        const Float4 extent = set.hi - set.lo;
        return std::min(1.0F / std::max({extent[0], extent[1], extent[2]}), 1e30F);
    }
    std::uint32_t of(const OneKind& tally) const {
        return block_costs[kind] * (block_width(kind) == 1 ? tally.count : (tally.count + 3) / 4);
    }
    static std::uint32_t of(const AnyKind& tally) { return blocks_cost(tally.counts); }
    template <class Tally>
    float of(const VectorBox& box, const Tally& tally) const {
        const Float4 e = (box.hi - box.lo) * scale;
        return (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]) * static_cast<float>(of(tally));
    }
};

/// Where a set is parted: what is in bins less than `position` along `axis` is on the left.
struct Border {
    int axis = 0;
    std::int32_t position = 0;
    float cost = std::numeric_limits<float>::infinity();  ///< area x price, summed over both sides
    std::size_t left_size = 0;
    std::size_t right_size = 0;

    bool found() const { return position > 0; }
    std::size_t larger_side() const { return std::max(left_size, right_size); }
};

/// What borders are possible.
struct SideLimits {
    std::size_t each;      ///< most primitives of a side
    std::size_t together;  ///< most of both, where some are on both
};

/// Tries every border between `bins`; keeps the best in `best`. Of equal costs (boxes without area)
/// the most balanced, then the first. A side that is empty costs infinitely many times nothing, which is no
/// number, and less than nothing else.
template <class Bin>
void sweep(std::span<const Bin> bins, const Price& price, int axis, const SideLimits& limits, Border& best) {
    struct Side {
        float cost;
        std::size_t size;
    };
    std::array<Side, most_bins> right_sides;
    VectorBox right_box;
    auto right = bins[0].exits();
    right = {};
    for (std::size_t i = bins.size() - 1; i > 0; --i) {
        right_box.extend(bins[i].box);
        right.add(bins[i].exits());
        right_sides[i] = {price.of(right_box, right), right.size()};
    }
    VectorBox left_box;
    auto left = right;
    left = {};
    for (std::size_t i = 1; i < bins.size(); ++i) {
        left_box.extend(bins[i - 1].box);
        left.add(bins[i - 1].entries());
        const Side left_side{price.of(left_box, left), left.size()};
        const Side right_side = right_sides[i];
        const std::size_t larger = std::max(left_side.size, right_side.size);
        if (larger > limits.each || left_side.size + right_side.size > limits.together) continue;
        const float cost = left_side.cost + right_side.cost;
        if (cost < best.cost || (cost == best.cost && larger < best.larger_side())) {
            best = {axis, static_cast<std::int32_t>(i), cost, left_side.size, right_side.size};
        }
    }
}

}  // namespace sahl
