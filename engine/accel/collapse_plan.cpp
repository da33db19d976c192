#include "engine/accel/collapse_plan.h"

#include <algorithm>

namespace sahl {

ForestCosts leaf_costs(float cost) {
    ForestCosts costs;
    costs.fill(cost);
    return costs;
}

PlannedNode plan_node(float visits, const ForestCosts& left, const ForestCosts& right) {
    PlannedNode node{};
    // Of each number of subtrees, the least cost with all ways to share them.
    std::array<float, wide_width + 1> shared{};
    std::array<std::uint32_t, wide_width + 1> left_share{};
    for (std::size_t subtrees = 2; subtrees <= wide_width; ++subtrees) {
        shared[subtrees] = left[0] + right[subtrees - 2];
        left_share[subtrees] = 1;
        for (std::size_t of_left = 2; of_left < subtrees; ++of_left) {
            const float cost = left[of_left - 1] + right[subtrees - of_left - 1];
            if (cost < shared[subtrees]) {
                shared[subtrees] = cost;
                left_share[subtrees] = static_cast<std::uint32_t>(of_left);
            }
        }
    }
    // As one child it is a wide node, whose children are the best cut of all.
    node.costs[0] = visits + shared[wide_width];
    node.plan = left_share[wide_width] << 4 * (wide_width - 2);
    for (std::size_t subtrees = 2; subtrees < wide_width; ++subtrees) {
        node.costs[subtrees - 1] = std::min(node.costs[subtrees - 2], shared[subtrees]);
        if (shared[subtrees] < node.costs[subtrees - 2])
            node.plan |= left_share[subtrees] << 4 * (subtrees - 2);
    }
    return node;
}

}  // namespace sahl
