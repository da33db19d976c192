// Parting a set of primitives in two, by one thread or several.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>

#include "engine/accel/bvh.h"
#include "engine/accel/parallel_chunks.h"

namespace sahl {

/// Makes two lists of ranges of equal size trade places; the ranges are disjoint.
void swap_ranges(std::span<const std::span<BuildPrimitive>> a, std::span<const std::span<BuildPrimitive>> b);

/// Moves the primitives for which `goes_left(primitive)` to the front and returns how many they are. In
/// place: large sets are parted chunk by chunk, and then what is on the wrong side changes places. The
/// order that results depends on the order before alone.
template <class Predicate>
std::size_t partition(std::span<BuildPrimitive> primitives, const Predicate& goes_left) {
    const auto partition_serially = [&](std::span<BuildPrimitive> part) {
        return static_cast<std::size_t>(std::partition(part.begin(), part.end(), goes_left) - part.begin());
    };
    if (primitives.size() < parallel_set_size) return partition_serially(primitives);

    const std::size_t chunks = (primitives.size() + parallel_grain - 1) / parallel_grain;
    const auto chunk_begin = [&](std::size_t chunk) {
        return std::min(chunk * parallel_grain, primitives.size());
    };
    std::vector<std::size_t> middles(chunks);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const std::size_t begin = chunk_begin(chunk);
        middles[chunk] =
            begin + partition_serially(primitives.subspan(begin, chunk_begin(chunk + 1) - begin));
    });
    std::size_t left_size = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) left_size += middles[chunk] - chunk_begin(chunk);

    std::vector<std::span<BuildPrimitive>> left_behind, right_before;  // of `left_size`
    const auto add_range = [&](auto& ranges, std::size_t begin, std::size_t end) {
        if (begin < end) ranges.push_back(primitives.subspan(begin, end - begin));
    };
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        add_range(left_behind, std::max(chunk_begin(chunk), left_size), middles[chunk]);
        add_range(right_before, middles[chunk], std::min(chunk_begin(chunk + 1), left_size));
    }
    swap_ranges(left_behind, right_before);
    return left_size;
}

/// The same by rank instead of place: the `left_size` primitives with the least centroids along
/// `axis` go to the front, equal ones in the order of their ids, then of their boxes.
void partition_by_rank(std::span<BuildPrimitive> primitives, int axis, std::size_t left_size);

}  // namespace sahl
