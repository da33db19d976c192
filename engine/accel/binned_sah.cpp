#include "engine/accel/binned_sah.h"

#include <algorithm>
#include <array>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace sahl {

namespace {

// Most sets are small, and with many bins clearing and sweeping empty ones would be most of the time.
constexpr std::size_t many_bins = 32;
constexpr std::size_t few_bins = 8;
constexpr std::size_t small_set_size = 32;
constexpr std::size_t reduce_grain = 1u << 14;

struct Bin {
    VectorBox box;
    KindCounts counts{};

    void add(const BuildPrimitive& primitive) {
        box.extend(load_lo(primitive), load_hi(primitive));
        ++counts[primitive.kind];
    }
    void add(const Bin& other) {
        box.extend(other.box);
        for (std::size_t kind = 0; kind < kind_count; ++kind) counts[kind] += other.counts[kind];
    }
};

// A set's primitives by place along each axis and by kind: kinds are the bins of a fourth axis.
template <std::size_t BinCount>
struct Bins {
    std::array<std::array<Bin, BinCount>, 3> axes;
    std::array<Bin, kind_count> kinds;
};

Grid make_grid(const SetSummary& summary, std::size_t bins) {
    Grid grid;
    grid.bins = static_cast<std::int32_t>(bins);
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = summary.centroids.hi[axis] - summary.centroids.lo[axis];
        grid.origin[axis] = summary.centroids.lo[axis];
        // Not for extents whose reciprocal overflows.
        grid.scale[axis] = extent > 1e-30f ? static_cast<float>(bins) / extent : 0.0f;
    }
    return grid;
}

template <std::size_t BinCount>
void fill(Bins<BinCount>& bins, const Grid& grid, bool mixed, std::span<const BuildPrimitive> primitives) {
    for (const BuildPrimitive& primitive : primitives) {
        const Int4 place = grid.bins_of(primitive);
        for (int axis = 0; axis < 3; ++axis) {
            bins.axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(place[axis])].add(primitive);
        }
        if (mixed) bins.kinds[primitive.kind].add(primitive);
    }
}

using ManyBins = Bins<many_bins>;

ManyBins fill_parallel(const Grid& grid, bool mixed, std::span<const BuildPrimitive> primitives) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, primitives.size(), reduce_grain), ManyBins{},
        [&](const tbb::blocked_range<std::size_t>& range, ManyBins bins) {
            fill(bins, grid, mixed, primitives.subspan(range.begin(), range.size()));
            return bins;
        },
        [](ManyBins bins, const ManyBins& other) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t i = 0; i < many_bins; ++i) bins.axes[axis][i].add(other.axes[axis][i]);
            }
            for (std::size_t kind = 0; kind < kind_count; ++kind) bins.kinds[kind].add(other.kinds[kind]);
            return bins;
        });
}

// One side of a split.
struct Side {
    double cost = 0;
    std::size_t size = 0;
};

Side side_of(const Bin& sum) {
    Side side;
    for (const std::uint32_t count : sum.counts) side.size += count;
    if (side.size > 0) side.cost = half_area(sum.box.bounds()) * blocks_cost(sum.counts);
    return side;
}

// Tries every border between `bins`; keeps the best in `best`. Of equal costs (boxes without area)
// the most balanced, then the first.
void sweep(std::span<const Bin> bins, const Grid& grid, int axis, std::size_t max_side, Split& best) {
    std::array<Side, many_bins> right_sides;
    Bin right;
    for (std::size_t i = bins.size() - 1; i > 0; --i) {
        right.add(bins[i]);
        right_sides[i] = side_of(right);
    }
    Bin left;
    for (std::size_t i = 1; i < bins.size(); ++i) {
        left.add(bins[i - 1]);
        const Side left_side = side_of(left);
        const Side right_side = right_sides[i];
        const std::size_t larger = std::max(left_side.size, right_side.size);
        if (left_side.size == 0 || right_side.size == 0 || larger > max_side) continue;
        const double cost = left_side.cost + right_side.cost;
        if (cost < best.cost || (cost == best.cost && larger < best.larger_side)) {
            best = {grid, axis, static_cast<std::int32_t>(i), cost, larger};
        }
    }
}

void add(SetSummary& summary, std::span<const BuildPrimitive> primitives) {
    for (const BuildPrimitive& primitive : primitives) {
        const Float4 lo = load_lo(primitive);
        const Float4 hi = load_hi(primitive);
        summary.box.extend(lo, hi);
        summary.centroids.extend(lo + hi, lo + hi);
        ++summary.counts[primitive.kind];
    }
}

template <std::size_t BinCount>
Split sweep_all(const Bins<BinCount>& bins, const Grid& grid, bool mixed, std::size_t max_side) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        sweep(bins.axes[static_cast<std::size_t>(axis)], grid, axis, max_side, best);
    }
    if (mixed) sweep(bins.kinds, grid, Split::by_kind, max_side, best);
    return best;
}

}  // namespace

SetSummary summarise(std::span<const BuildPrimitive> primitives) {
    if (primitives.size() < parallel_set_size) {
        SetSummary summary;
        add(summary, primitives);
        return summary;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, primitives.size(), reduce_grain), SetSummary{},
        [&](const tbb::blocked_range<std::size_t>& range, SetSummary summary) {
            add(summary, primitives.subspan(range.begin(), range.size()));
            return summary;
        },
        [](SetSummary summary, const SetSummary& other) {
            summary.box.extend(other.box);
            summary.centroids.extend(other.centroids);
            for (std::size_t kind = 0; kind < kind_count; ++kind) summary.counts[kind] += other.counts[kind];
            return summary;
        });
}

Split find_split(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                 std::size_t max_side) {
    const auto absent =
        static_cast<std::size_t>(std::count(summary.counts.begin(), summary.counts.end(), 0u));
    const bool mixed = absent + 1 < kind_count;
    if (primitives.size() <= small_set_size) {
        const Grid grid = make_grid(summary, few_bins);
        Bins<few_bins> bins;
        fill(bins, grid, mixed, primitives);
        return sweep_all(bins, grid, mixed, max_side);
    }
    const Grid grid = make_grid(summary, many_bins);
    ManyBins bins;
    if (primitives.size() < parallel_set_size) {
        fill(bins, grid, mixed, primitives);
    } else {
        bins = fill_parallel(grid, mixed, primitives);
    }
    return sweep_all(bins, grid, mixed, max_side);
}

}  // namespace sahl
