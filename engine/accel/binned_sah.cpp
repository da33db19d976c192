#include "engine/accel/binned_sah.h"

#include <algorithm>
#include <array>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace sahl {

namespace {

constexpr std::size_t max_bins = 32;
constexpr std::size_t reduce_grain = 1u << 14;

struct Bin {
    VectorBox box;
    KindCounts counts;

    void add(const BuildPrimitive& primitive) {
        box.extend(load_lo(primitive), load_hi(primitive));
        ++counts[primitive.kind];
    }
    void add(const Bin& other) {
        box.extend(other.box);
        for (std::size_t kind = 0; kind < kind_count; ++kind) counts[kind] += other.counts[kind];
    }
};

constexpr Bin empty_bin{{}, {}};

// A set's primitives by place along each axis and by kind: kinds are the bins of a fourth axis.
struct Bins {
    std::array<std::array<Bin, max_bins>, 3> axes;
    std::array<Bin, kind_count> kinds;
};

Grid make_grid(const SetSummary& summary, std::size_t size) {
    // Most sets are small, and sweeping over more bins than primitives would be most of the time.
    const std::size_t bins = std::clamp<std::size_t>(size, 8, max_bins);
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

void clear(Bins& bins, const Grid& grid) {
    for (auto& axis : bins.axes) std::fill_n(axis.begin(), grid.bins, empty_bin);
    bins.kinds.fill(empty_bin);
}

void fill(Bins& bins, const Grid& grid, bool mixed, std::span<const BuildPrimitive> primitives) {
    for (const BuildPrimitive& primitive : primitives) {
        const Int4 place = grid.bins_of(primitive);
        for (int axis = 0; axis < 3; ++axis) {
            bins.axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(place[axis])].add(primitive);
        }
        if (mixed) bins.kinds[primitive.kind].add(primitive);
    }
}

void fill_parallel(Bins& bins, const Grid& grid, bool mixed, std::span<const BuildPrimitive> primitives) {
    const Bins cleared = bins;
    bins = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, primitives.size(), reduce_grain), cleared,
        [&](const tbb::blocked_range<std::size_t>& range, Bins sum) {
            fill(sum, grid, mixed, primitives.subspan(range.begin(), range.size()));
            return sum;
        },
        [](Bins sum, const Bins& other) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t i = 0; i < max_bins; ++i) sum.axes[axis][i].add(other.axes[axis][i]);
            }
            for (std::size_t kind = 0; kind < kind_count; ++kind) sum.kinds[kind].add(other.kinds[kind]);
            return sum;
        });
}

std::size_t size_of(const KindCounts& counts) {
    std::size_t size = 0;
    for (const std::uint32_t count : counts) size += count;
    return size;
}

double cost_of(const Bin& side) { return half_area(side.box.bounds()) * blocks_cost(side.counts); }

// Tries every border between `bins`; keeps the best in `best`. Of equal costs (boxes without area)
// the most balanced, then the first.
void sweep(std::span<const Bin> bins, const Grid& grid, int axis, std::size_t max_side, Split& best) {
    std::array<Bin, max_bins> right;
    right[bins.size() - 1] = bins.back();
    for (std::size_t i = bins.size() - 1; i-- > 1;) {
        right[i] = right[i + 1];
        right[i].add(bins[i]);
    }
    Bin left = empty_bin;
    for (std::size_t i = 1; i < bins.size(); ++i) {
        left.add(bins[i - 1]);
        const std::size_t left_size = size_of(left.counts);
        const std::size_t right_size = size_of(right[i].counts);
        const std::size_t larger = std::max(left_size, right_size);
        if (left_size == 0 || right_size == 0 || larger > max_side) continue;
        const double cost = cost_of(left) + cost_of(right[i]);
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
    const Grid grid = make_grid(summary, primitives.size());
    Bins bins;
    clear(bins, grid);
    if (primitives.size() < parallel_set_size) {
        fill(bins, grid, mixed, primitives);
    } else {
        fill_parallel(bins, grid, mixed, primitives);
    }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto used = std::span(bins.axes[axis]).first(static_cast<std::size_t>(grid.bins));
        sweep(used, grid, static_cast<int>(axis), max_side, best);
    }
    if (mixed) sweep(bins.kinds, grid, Split::by_kind, max_side, best);
    return best;
}

}  // namespace sahl
