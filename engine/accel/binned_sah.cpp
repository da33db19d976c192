#include "engine/accel/binned_sah.h"

#include <algorithm>
#include <array>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "engine/accel/parallel_chunks.h"

namespace sahl {

namespace {

template <class Tally>
struct Bin {
    VectorBox box;
    Tally tally;

    void add(const BuildPrimitive& primitive) {
        box.extend(load_lo(primitive), load_hi(primitive));
        tally.add(primitive.kind);
    }
    void add(const Bin& other) {
        box.extend(other.box);
        tally.add(other.tally);
    }
    const Tally& entries() const { return tally; }
    const Tally& exits() const { return tally; }
};

// Axes first, ... last - 1.
struct AxisRange {
    int first;
    int last;
};

// A set's primitives by place along each axis and by kind: kinds are the bins of a fourth axis.
template <class Tally, std::size_t BinCount>
struct Bins {
    std::array<std::array<Bin<Tally>, BinCount>, 3> axes;
    std::array<Bin<Tally>, std::is_same_v<Tally, AnyKind> ? kind_count : 0> kinds;

    void fill(const Grid& grid, const AxisRange& along, std::span<const BuildPrimitive> primitives) {
        if (along.last - along.first == 3) {
            for (const BuildPrimitive& primitive : primitives) {
                const Int4 place = grid.bins_at(load_lo(primitive) + load_hi(primitive));
                for (int axis = 0; axis < 3; ++axis) {
                    axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(place[axis])].add(
                        primitive);
                }
            }
        } else {
            auto& bins = axes[static_cast<std::size_t>(along.first)];
            for (const BuildPrimitive& primitive : primitives) {
                bins[static_cast<std::size_t>(grid.bin_of(primitive, along.first))].add(primitive);
            }
        }
        if constexpr (std::is_same_v<Tally, AnyKind>) {
            for (const BuildPrimitive& primitive : primitives) kinds[primitive.kind].add(primitive);
        }
    }
    void add(const Bins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < BinCount; ++i) axes[axis][i].add(other.axes[axis][i]);
        }
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) kinds[kind].add(other.kinds[kind]);
    }
    std::span<const Bin<Tally>> along(int axis) const {
        if (axis == ObjectSplit::by_kind) return kinds;
        return axes[static_cast<std::size_t>(axis)];
    }
};

template <class Tally, std::size_t BinCount>
ObjectSplit find(std::span<const BuildPrimitive> primitives, const SetSummary& summary, const Price& price,
                 const AxisRange& axes, std::size_t max_side) {
    using SetBins = Bins<Tally, BinCount>;
    ObjectSplit split;
    split.grid = make_grid(summary.centroids, BinCount);
    SetBins bins;
    if (primitives.size() < parallel_set_size) {
        bins.fill(split.grid, axes, primitives);
    } else {
        bins = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, primitives.size(), parallel_grain), SetBins{},
            [&](const tbb::blocked_range<std::size_t>& range, SetBins sum) {
                sum.fill(split.grid, axes, primitives.subspan(range.begin(), range.size()));
                return sum;
            },
            [](SetBins sum, const SetBins& other) {
                sum.add(other);
                return sum;
            });
    }
    const SideLimits limits{max_side, primitives.size()};
    for (int axis = axes.first; axis < axes.last; ++axis) {
        sweep(bins.along(axis), price, axis, limits, split.border);
    }
    if constexpr (std::is_same_v<Tally, AnyKind>) {
        sweep(bins.along(ObjectSplit::by_kind), price, ObjectSplit::by_kind, limits, split.border);
    }
    if (split.found()) {
        const auto best = bins.along(split.border.axis);
        const auto position = static_cast<std::size_t>(split.border.position);
        for (std::size_t i = 0; i < best.size(); ++i) {
            (i < position ? split.left : split.right).extend(best[i].box);
        }
    }
    return split;
}

// Clearing and sweeping bins must not take longer than filling them.
template <class Tally>
ObjectSplit find_among(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                       const Price& price, const AxisRange& axes, std::size_t max_side) {
    if (primitives.size() <= 32) return find<Tally, 8>(primitives, summary, price, axes, max_side);
    if (primitives.size() <= 256) return find<Tally, 16>(primitives, summary, price, axes, max_side);
    return find<Tally, most_bins>(primitives, summary, price, axes, max_side);
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

bool SetSummary::mixed() const {
    const auto absent = std::count(counts.begin(), counts.end(), 0U);
    return static_cast<std::size_t>(absent) + 1 < kind_count;
}

SetSummary summarise(std::span<const BuildPrimitive> primitives) {
    if (primitives.size() < parallel_set_size) {
        SetSummary summary;
        add(summary, primitives);
        return summary;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, primitives.size(), parallel_grain), SetSummary{},
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

ObjectSplit find_object_split(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                              std::size_t max_side, BuildQuality quality) {
    AxisRange axes{0, 3};
    if (quality == BuildQuality::fast) {
        const int longest = summary.centroids.longest_axis();
        axes = {longest, longest + 1};
    }
    const Price price{Price::scale_of(summary.box), primitives.front().kind};
    if (summary.mixed()) return find_among<AnyKind>(primitives, summary, price, axes, max_side);
    return find_among<OneKind>(primitives, summary, price, axes, max_side);
}

}  // namespace sahl
