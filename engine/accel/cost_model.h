// What the surface area heuristic counts: visits, in units of half a node visit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/device_types.h"

namespace sahl {

inline constexpr std::size_t kind_count = 9;

/// Primitives by SAHL_KIND_*.
using KindCounts = std::array<std::uint32_t, kind_count>;

inline constexpr std::uint32_t node_visit_cost = 2;

/// The cost of testing a ray against one block. A node is four lines and 8 slab tests. Triangle
/// and sphere blocks load less and compute about as much in one float4 pass; a block of shapes in
/// object spaces adds a 3x3 transform and loads four lines; a polygon block fetches its vertices one
/// by one; an instance is a transform in double precision and a tree.
inline constexpr std::array<std::uint32_t, kind_count> block_costs{2, 2, 3, 3, 4, 4, 3, 3, 12};

/// How many primitives of a kind a leaf holds. Polygons are walked corner by corner, so that a box of its own
/// for each costs less than a block of four whose every outline is walked.
constexpr std::uint32_t block_width(std::size_t kind) {
    return kind == SAHL_KIND_INSTANCE || kind == SAHL_KIND_POLYGON ? 1 : SAHL_BLOCK_WIDTH;
}

/// The cost of testing everything, as if the primitives of a kind fill their blocks.
inline std::uint32_t blocks_cost(const KindCounts& counts) {
    std::uint32_t cost = 0;
    for (std::size_t kind = 0; kind < kind_count; ++kind) {
        cost += block_costs[kind] * ((counts[kind] + block_width(kind) - 1) / block_width(kind));
    }
    return cost;
}

}  // namespace sahl
