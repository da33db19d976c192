#include "engine/accel/spatial_split.h"

#include <array>
#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "engine/accel/cut_reference.h"
#include "engine/accel/parallel_chunks.h"

namespace sahl {

namespace {

constexpr std::size_t spatial_bins = 8;

// Marks, in BuildPrimitive::kind, what has been sent to the right.
constexpr std::uint32_t to_right = 0x80000000U;

bool can_cut(const BuildPrimitive& reference) { return reference.kind == SAHL_KIND_TRIANGLE; }

// The first and last bins of a reference along x, y and z.
struct BinRange {
    Int4 first;
    Int4 last;
};

BinRange bins_of(const BuildPrimitive& reference, const Grid& grid) {
    const Float4 lo = load_lo(reference);
    const Float4 hi = load_hi(reference);
    if (can_cut(reference)) return {grid.bins_at(lo), grid.bins_at(hi)};
    const Int4 bin = grid.bins_at(lo * 0.5F + hi * 0.5F);
    return {bin, bin};
}

template <class Tally>
struct SpatialBin {
    VectorBox box;
    Tally begins;
    Tally ends;

    void add(const SpatialBin& other) {
        box.extend(other.box);
        begins.add(other.begins);
        ends.add(other.ends);
    }
    const Tally& entries() const { return begins; }
    const Tally& exits() const { return ends; }
};

template <class Tally>
struct SpatialBins {
    std::array<std::array<SpatialBin<Tally>, spatial_bins>, 3> axes;

    void fill(const Grid& grid, std::span<const BuildPrimitive> references, const TriangleCorners& corners) {
        for (const BuildPrimitive& reference : references) {
            const BinRange range = bins_of(reference, grid);
            for (int axis = 0; axis < 3; ++axis) {
                auto& bins = axes[static_cast<std::size_t>(axis)];
                const std::int32_t first = range.first[axis];
                const std::int32_t last = range.last[axis];
                bins[static_cast<std::size_t>(first)].begins.add(reference.kind);
                bins[static_cast<std::size_t>(last)].ends.add(reference.kind);
                VectorBox rest = box_of(reference);
                for (std::int32_t bin = first; bin < last && !is_empty(rest); ++bin) {
                    const CutBoxes cut =
                        cut_triangle(corners.of(reference.id), rest, axis, grid.border(axis, bin + 1));
                    if (!is_empty(cut.below)) bins[static_cast<std::size_t>(bin)].box.extend(cut.below);
                    rest = cut.above;
                }
                if (!is_empty(rest)) bins[static_cast<std::size_t>(last)].box.extend(rest);
            }
        }
    }
    void add(const SpatialBins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < spatial_bins; ++i) axes[axis][i].add(other.axes[axis][i]);
        }
    }
};

template <class Tally>
void find(SpatialSplit& split, std::span<const BuildPrimitive> references, const TriangleCorners& corners,
          const Price& price, const SideLimits& limits) {
    SpatialBins<Tally> bins;
    if (references.size() < parallel_set_size) {
        bins.fill(split.grid, references, corners);
    } else {
        bins = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, references.size(), parallel_grain), SpatialBins<Tally>{},
            [&](const tbb::blocked_range<std::size_t>& range, SpatialBins<Tally> sum) {
                sum.fill(split.grid, references.subspan(range.begin(), range.size()), corners);
                return sum;
            },
            [](SpatialBins<Tally> sum, const SpatialBins<Tally>& other) {
                sum.add(other);
                return sum;
            });
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (split.grid.scale[axis] == 0.0F) continue;
        sweep(std::span<const SpatialBin<Tally>>(bins.axes[static_cast<std::size_t>(axis)]), price, axis,
              limits, split.border);
    }
    if (!split.found()) return;
    const auto& best = bins.axes[static_cast<std::size_t>(split.border.axis)];
    for (std::size_t i = 0; i < spatial_bins; ++i) {
        (i < static_cast<std::size_t>(split.border.position) ? split.left : split.right).extend(best[i].box);
    }
}

// Sends references to the sides of a plane.
struct Cutting {
    const SpatialSplit& split;
    const TriangleCorners& corners;
    double left_area = half_area(split.left);
    double right_area = half_area(split.right);
    double left_size = static_cast<double>(split.border.left_size);
    double right_size = static_cast<double>(split.border.right_size);

    // Marks `reference` if it goes to the right. True if it goes to both sides: then it becomes its left
    // part, and `part` its right one.
    bool send(BuildPrimitive& reference, BuildPrimitive& part) const;
};

bool Cutting::send(BuildPrimitive& reference, BuildPrimitive& part) const {
    const auto& [axis, position, cost, left_count, right_count] = split.border;
    const BinRange range = bins_of(reference, split.grid);
    if (range.last[axis] < position) return false;
    if (range.first[axis] >= position) {
        reference.kind |= to_right;
        return false;
    }
    const VectorBox box = box_of(reference);
    const CutBoxes cut = cut_triangle(corners.of(reference.id), box, axis, split.grid.border(axis, position));
    if (is_empty(cut.above)) return false;
    if (is_empty(cut.below)) {
        reference.kind |= to_right;
        return false;
    }
    const double both = left_area * left_size + right_area * right_size;
    const double left = half_area(split.left.with(box)) * left_size + right_area * (right_size - 1);
    const double right = left_area * (left_size - 1) + half_area(split.right.with(box)) * right_size;
    if (left <= both && left <= right) return false;
    if (right <= both) {
        reference.kind |= to_right;
        return false;
    }
    part = reference;
    part.kind |= to_right;
    part.bounds = cut.above.bounds();
    reference.bounds = cut.below.bounds();
    return true;
}

}  // namespace

SpatialSplit find_spatial_split(std::span<const BuildPrimitive> references, const TriangleCorners& corners,
                                const SetSummary& summary, std::size_t max_side, std::size_t max_together) {
    SpatialSplit split;
    split.grid = make_grid(summary.box, spatial_bins);
    const SideLimits limits{max_side, max_together};
    const Price price{Price::scale_of(summary.box), references.front().kind};
    if (summary.mixed()) {
        find<AnyKind>(split, references, corners, price, limits);
    } else {
        find<OneKind>(split, references, corners, price, limits);
    }
    return split;
}

Parted apply(const SpatialSplit& split, std::span<BuildPrimitive> references, std::size_t size,
             const TriangleCorners& corners) {
    const Cutting cutting{split, corners};
    std::atomic<std::size_t> end = size;
    for_chunks(size, [&](std::size_t chunk_begin, std::size_t chunk_end) {
        for (std::size_t i = chunk_begin; i < chunk_end; ++i) {
            BuildPrimitive part;
            if (cutting.send(references[i], part)) references[end++] = part;
        }
    });
    const auto all = references.first(end);
    const Parted parted = partition(all, [](const BuildPrimitive& p) { return (p.kind & to_right) == 0; });
    const auto right = all.subspan(parted.left.size);
    for_chunks(right.size(), [&](std::size_t chunk_begin, std::size_t chunk_end) {
        for (std::size_t i = chunk_begin; i < chunk_end; ++i) right[i].kind &= ~to_right;
    });
    return parted;
}

}  // namespace sahl
