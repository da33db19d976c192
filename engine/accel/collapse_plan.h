// Which nodes of a binary tree become the children of wide ones, at least cost: dynamic programming from the
// leaves up.
// Source: Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", sec. 3.1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sahl {

inline constexpr std::size_t wide_width = 8;

/// [i]: the least cost of a subtree as at most i + 1 children of a wide node, in visits of nodes by a ray
/// that meets the root.
using ForestCosts = std::array<float, wide_width - 1>;

/// How a binary node is best cut into at most 2..8 subtrees: four bits for each of these numbers, how many of
/// them its left child gets; 0 if fewer subtrees do as well.
using CutPlan = std::uint32_t;

/// How many of at most `subtrees` (2..8) the left child gets and how many are used; 1 used: the node itself.
struct CutShare {
    std::uint32_t left;
    std::uint32_t used;
};
inline CutShare share_of(CutPlan plan, std::uint32_t subtrees) {
    for (; subtrees > 1; --subtrees) {
        const std::uint32_t left = plan >> 4 * (subtrees - 2) & 15U;
        if (left > 0) return {left, subtrees};
    }
    return {0, 1};
}

/// The costs of a leaf, `cost` however many children it may be.
ForestCosts leaf_costs(float cost);

struct PlannedNode {
    ForestCosts costs;
    CutPlan plan;
};

/// The costs of a node that a ray visits with probability `visits`, from its children's.
PlannedNode plan_node(float visits, const ForestCosts& left, const ForestCosts& right);

}  // namespace sahl
