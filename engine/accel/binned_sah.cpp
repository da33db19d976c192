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

// A set's primitives by place along one axis or all three, from `first` on, and by kind: kinds are the bins
// of a fourth axis.
template <class Tally, std::size_t BinCount, std::size_t AxisCount>
struct Bins {
    std::array<std::array<Bin<Tally>, BinCount>, AxisCount> axes;
    std::array<Bin<Tally>, std::is_same_v<Tally, AnyKind> ? kind_count : 0> kinds;

    void fill(const Grid& grid, int first, std::span<const BuildPrimitive> primitives) {
        if constexpr (AxisCount == 3) {
            for (const BuildPrimitive& primitive : primitives) {
                const Int4 place = grid.bins_at(load_lo(primitive) + load_hi(primitive));
                for (int axis = 0; axis < 3; ++axis) {
                    axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(place[axis])].add(
                        primitive);
                }
            }
        } else {
            for (const BuildPrimitive& primitive : primitives) {
                axes[0][static_cast<std::size_t>(grid.bin_of(primitive, first))].add(primitive);
            }
        }
        if constexpr (std::is_same_v<Tally, AnyKind>) {
            for (const BuildPrimitive& primitive : primitives) kinds[primitive.kind].add(primitive);
        }
    }
    void add(const Bins& other) {
        for (std::size_t axis = 0; axis < AxisCount; ++axis) {
            for (std::size_t i = 0; i < BinCount; ++i) axes[axis][i].add(other.axes[axis][i]);
        }
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) kinds[kind].add(other.kinds[kind]);
    }
    std::span<const Bin<Tally>> along(int axis, int first) const {
        if (axis == ObjectSplit::by_kind) return kinds;
        return axes[static_cast<std::size_t>(axis - first)];
    }
};

// Along the axes from `first` on.
template <class Tally, std::size_t BinCount, std::size_t AxisCount>
ObjectSplit find(std::span<const BuildPrimitive> primitives, const SetSummary& summary, const Price& price,
                 int first, std::size_t max_side) {
    using SetBins = Bins<Tally, BinCount, AxisCount>;
    ObjectSplit split;
    split.grid = make_grid(summary.centroids, BinCount);
    SetBins bins;
    if (primitives.size() < parallel_set_size) {
        bins.fill(split.grid, first, primitives);
    } else {
        bins = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, primitives.size(), parallel_grain), SetBins{},
            [&](const tbb::blocked_range<std::size_t>& range, SetBins sum) {
                sum.fill(split.grid, first, primitives.subspan(range.begin(), range.size()));
                return sum;
            },
            [](SetBins sum, const SetBins& other) {
                sum.add(other);
                return sum;
            });
    }
    const SideLimits limits{max_side, primitives.size()};
    for (int axis = first; axis < first + static_cast<int>(AxisCount); ++axis) {
        sweep(bins.along(axis, first), price, axis, limits, split.border);
    }
    if constexpr (std::is_same_v<Tally, AnyKind>) {
        sweep(bins.along(ObjectSplit::by_kind, first), price, ObjectSplit::by_kind, limits, split.border);
    }
    if (split.found()) {
        const auto best = bins.along(split.border.axis, first);
        const auto position = static_cast<std::size_t>(split.border.position);
        for (std::size_t i = 0; i < best.size(); ++i) {
            (i < position ? split.left : split.right).extend(best[i].box);
        }
    }
    return split;
}

// Clearing and sweeping bins must not take longer than filling them.
template <class Tally, std::size_t AxisCount>
ObjectSplit find_among(std::span<const BuildPrimitive> primitives, const SetSummary& summary, int first,
                       std::size_t max_side) {
    const Price price{Price::scale_of(summary.box), primitives.front().kind};
    if (primitives.size() <= 32)
        return find<Tally, 8, AxisCount>(primitives, summary, price, first, max_side);
    if (primitives.size() <= 256)
        return find<Tally, 16, AxisCount>(primitives, summary, price, first, max_side);
    return find<Tally, most_bins, AxisCount>(primitives, summary, price, first, max_side);
}

template <class Tally>
ObjectSplit find_among(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                       std::size_t max_side, BuildQuality quality) {
    if (quality == BuildQuality::high) return find_among<Tally, 3>(primitives, summary, 0, max_side);
    return find_among<Tally, 1>(primitives, summary, summary.centroids.longest_axis(), max_side);
}

}  // namespace

ObjectSplit find_object_split(std::span<const BuildPrimitive> primitives, const SetSummary& summary,
                              std::size_t max_side, BuildQuality quality) {
    if (summary.mixed()) return find_among<AnyKind>(primitives, summary, max_side, quality);
    return find_among<OneKind>(primitives, summary, max_side, quality);
}

}  // namespace sahl
