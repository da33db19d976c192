#include "engine/accel/partition.h"

#include <algorithm>
#include <vector>

#include <tbb/parallel_for.h>

namespace sahl {

namespace {

constexpr std::size_t chunk_size = 1u << 14;

// Counts what goes left in each chunk, gives each chunk its places on both sides, and moves all
// through `scratch`. Stable, so it does not matter who moves which chunk when.
std::size_t partition_parallel(std::span<BuildPrimitive> primitives, std::span<BuildPrimitive> scratch,
                               const Split& split) {
    const std::size_t chunks = (primitives.size() + chunk_size - 1) / chunk_size;
    const auto chunk_of = [&](std::size_t chunk) {
        const std::size_t begin = chunk * chunk_size;
        return primitives.subspan(begin, std::min(chunk_size, primitives.size() - begin));
    };
    std::vector<std::size_t> left_before(chunks + 1, 0);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const auto part = chunk_of(chunk);
        const auto left = std::count_if(part.begin(), part.end(), [&](const BuildPrimitive& primitive) {
            return split.goes_left(primitive);
        });
        left_before[chunk + 1] = static_cast<std::size_t>(left);
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) left_before[chunk + 1] += left_before[chunk];
    const std::size_t left_size = left_before[chunks];
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        std::size_t left = left_before[chunk];
        std::size_t right = left_size + chunk * chunk_size - left;
        for (const BuildPrimitive& primitive : chunk_of(chunk)) {
            scratch[split.goes_left(primitive) ? left++ : right++] = primitive;
        }
    });
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const auto part = chunk_of(chunk);
        std::copy_n(scratch.begin() + static_cast<std::ptrdiff_t>(chunk * chunk_size), part.size(),
                    part.begin());
    });
    return left_size;
}

}  // namespace

std::size_t partition(std::span<BuildPrimitive> primitives, std::span<BuildPrimitive> scratch,
                      const Split& split) {
    if (primitives.size() >= parallel_set_size) return partition_parallel(primitives, scratch, split);
    const auto middle =
        std::partition(primitives.begin(), primitives.end(),
                       [&](const BuildPrimitive& primitive) { return split.goes_left(primitive); });
    return static_cast<std::size_t>(middle - primitives.begin());
}

void partition_by_rank(std::span<BuildPrimitive> primitives, int axis, std::size_t left_size) {
    std::nth_element(primitives.begin(), primitives.begin() + static_cast<std::ptrdiff_t>(left_size),
                     primitives.end(), [&](const BuildPrimitive& a, const BuildPrimitive& b) {
                         const float centroid_a = a.bounds.lo[axis] + a.bounds.hi[axis];
                         const float centroid_b = b.bounds.lo[axis] + b.bounds.hi[axis];
                         return centroid_a != centroid_b ? centroid_a < centroid_b : a.id < b.id;
                     });
}

}  // namespace sahl
