#include "engine/accel/bvh.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "engine/accel/binary_tree.h"
#include "engine/accel/cost_model.h"
#include "engine/accel/wide_collapse.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

void check_size(const std::vector<BuildPrimitive>& primitives) {
    if (primitives.size() > SAHL_MAX_PRIMITIVES) {
        throw Error(ExitCode::scene, "the scene has " + std::to_string(primitives.size()) +
                                         " primitives; the limit is " + std::to_string(SAHL_MAX_PRIMITIVES) +
                                         ": render fewer");
    }
}

Bounds slot_bounds(const device::BvhNode& node, std::size_t slot) {
    return {{node.lo_x[slot], node.lo_y[slot], node.lo_z[slot]},
            {node.hi_x[slot], node.hi_y[slot], node.hi_z[slot]}};
}

// Depth-first order puts parents before children: levels are known in one pass.
BvhStatistics measure(const Bvh& bvh, std::size_t primitives) {
    BvhStatistics statistics;
    statistics.primitives = primitives;
    statistics.nodes = bvh.nodes.size();
    statistics.leaves = bvh.leaves.size();
    const double root_area = half_area(bvh.bounds);
    std::vector<int> levels(bvh.nodes.size(), 1);
    double cost = node_visit_cost;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        statistics.depth = std::max(statistics.depth, levels[i]);
        for (std::size_t slot = 0; slot < 8; ++slot) {
            const Bounds bounds = slot_bounds(bvh.nodes[i], slot);
            const std::uint32_t child = bvh.nodes[i].child[slot];
            if (bounds.lo[0] > bounds.hi[0]) continue;
            const double visits = root_area > 0 ? half_area(bounds) / root_area : 1.0;
            const bool leaf = (child & SAHL_CHILD_LEAF) != 0;
            const std::uint32_t kind = child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK;
            cost += visits * (leaf ? block_costs[kind] : node_visit_cost);
            if (!leaf) levels[child] = levels[i] + 1;
        }
    }
    statistics.sah_cost = cost / node_visit_cost;
    for (const BvhLeaf& leaf : bvh.leaves) statistics.references += leaf.count;
    if (statistics.leaves > 0) {
        statistics.leaf_fill =
            static_cast<double>(statistics.references) / static_cast<double>(statistics.leaves);
    }
    return statistics;
}

}  // namespace

Bvh build_bvh(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners, BuildQuality quality) {
    const auto start = std::chrono::steady_clock::now();
    check_size(primitives);
    const std::size_t size = primitives.size();
    Bvh bvh;
    if (primitives.empty()) {
        bvh.nodes.push_back(empty_node());
    } else {
        BinaryTree tree = build_binary_tree(std::move(primitives), corners, quality);
        collapse(tree, bvh);
        bvh.bounds = tree.bounds;
    }
    bvh.statistics = measure(bvh, size);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    bvh.statistics.build_seconds = seconds.count();
    return bvh;
}

std::uint32_t append_tree(Bvh& forest, const Bvh& tree) {
    const std::size_t root = forest.nodes.size();
    const std::uint64_t lines = std::uint64_t{forest.leaf_lines} + tree.leaf_lines;
    if (root + tree.nodes.size() > SAHL_CHILD_LEAF || lines > SAHL_CHILD_OFFSET_MASK + 1U) {
        throw Error(ExitCode::scene,
                    "the scene's groups have more primitives together than one acceleration structure can "
                    "address: render fewer at a time");
    }
    for (device::BvhNode node : tree.nodes) {
        for (std::size_t slot = 0; slot < 8; ++slot) {
            std::uint32_t& child = node.child[slot];
            const bool leaf = (child & SAHL_CHILD_LEAF) != 0;
            const bool empty = node.lo_x[slot] > node.hi_x[slot];
            const std::uint32_t kind = child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK;
            if (empty || (leaf && kind == SAHL_KIND_INSTANCE)) continue;
            child += leaf ? forest.leaf_lines : static_cast<std::uint32_t>(root);
        }
        forest.nodes.push_back(node);
    }
    forest.leaves.insert(forest.leaves.end(), tree.leaves.begin(), tree.leaves.end());
    forest.leaf_lines = static_cast<std::uint32_t>(lines);
    return static_cast<std::uint32_t>(root);
}

}  // namespace sahl
