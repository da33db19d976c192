// Parting a set of primitives in two, by one thread or several.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>

#include "engine/accel/bvh.h"
#include "engine/accel/parallel_chunks.h"
#include "engine/accel/set_summary.h"

namespace sahl {

/// The sides of a set that was parted, those of the left one first.
struct Parted {
    SetSummary left{};
    SetSummary right{};
};

/// Makes two lists of ranges of equal size trade places; the ranges are disjoint.
void swap_ranges(std::span<const std::span<BuildPrimitive>> a, std::span<const std::span<BuildPrimitive>> b);

/// Moves the primitives for which `goes_left(primitive)` to the front, by one thread. The sides are
/// summarised on the way: what is moved is at hand.
template <class Predicate>
Parted partition_serially(std::span<BuildPrimitive> primitives, const Predicate& goes_left) {
    SetSummary left, right;
    BuildPrimitive* first = primitives.data();
    BuildPrimitive* last = first + primitives.size();
    for (;;) {
        while (first < last && goes_left(*first)) left.add(*first++);
        while (first < last && !goes_left(last[-1])) right.add(*--last);
        if (first == last) return {left, right};
        left.add(*--last);
        right.add(*first);
        trade_places(*first++, *last);
    }
}

/// The same by several threads where the set is large. In place: large sets are parted chunk by chunk, and
/// then what is on the wrong side changes places. The order that results depends on the order before alone.
template <class Predicate>
Parted partition(std::span<BuildPrimitive> primitives, const Predicate& goes_left) {
    if (primitives.size() < parallel_set_size) return partition_serially(primitives, goes_left);

    const std::size_t chunks = (primitives.size() + parallel_grain - 1) / parallel_grain;
    const auto chunk_begin = [&](std::size_t chunk) {
        return std::min(chunk * parallel_grain, primitives.size());
    };
    std::vector<Parted> parted(chunks);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const std::size_t begin = chunk_begin(chunk);
        parted[chunk] =
            partition_serially(primitives.subspan(begin, chunk_begin(chunk + 1) - begin), goes_left);
    });
    Parted whole;
    for (const Parted& part : parted) {
        whole.left = whole.left + part.left;
        whole.right = whole.right + part.right;
    }

    std::vector<std::span<BuildPrimitive>> left_behind, right_before;  // `whole.left.size`
    const auto add_range = [&](auto& ranges, std::size_t begin, std::size_t end) {
        if (begin < end) ranges.push_back(primitives.subspan(begin, end - begin));
    };
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t middle = chunk_begin(chunk) + parted[chunk].left.size;
        add_range(left_behind, std::max(chunk_begin(chunk), whole.left.size), middle);
        add_range(right_before, middle, std::min(chunk_begin(chunk + 1), whole.left.size));
    }
    swap_ranges(left_behind, right_before);
    return whole;
}

/// The same by rank instead of place: the `left_size` primitives with the least centroids along
/// `axis` go to the front, equal ones in the order of their ids, then of their boxes.
Parted partition_by_rank(std::span<BuildPrimitive> primitives, int axis, std::size_t left_size);

}  // namespace sahl
