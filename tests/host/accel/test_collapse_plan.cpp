#include "engine/accel/collapse_plan.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/host/accel/boxes.h"

using namespace sahl;
using namespace sahl::test;

namespace {

// A binary tree with the visits of its nodes; leaves cost that.
struct Tree {
    struct Node {
        float visits = 0;
        int left = -1, right = -1;
        PlannedNode planned{};
    };
    std::vector<Node> nodes;

    int grow(std::size_t leaves, std::mt19937& random) {
        const int index = static_cast<int>(nodes.size());
        nodes.emplace_back();
        const float visits = uniform(random);
        const auto at = [&]() -> Node& { return nodes[static_cast<std::size_t>(index)]; };
        at().visits = visits;
        if (leaves == 1) {
            at().planned = {leaf_costs(visits), 0};
            return index;
        }
        const std::size_t to_left = 1 + random() % (leaves - 1);
        const int left = grow(to_left, random);
        const int right = grow(leaves - to_left, random);
        at().left = left;
        at().right = right;
        at().planned = plan_node(visits, planned(left).costs, planned(right).costs);
        return index;
    }
    const PlannedNode& planned(int node) const { return nodes[static_cast<std::size_t>(node)].planned; }

    /// The least cost of `node` as one child, by trying all cuts with at most eight subtrees.
    float least(int node) const {
        const Node& n = nodes[static_cast<std::size_t>(node)];
        if (n.left < 0) return n.visits;
        float best = std::numeric_limits<float>::infinity();
        for (const auto& [size, cost] : cuts(node)) {
            if (size >= 2 && size <= 8) best = std::min(best, cost);
        }
        return n.visits + best;
    }
    /// Sizes and costs of all cuts through the subtree.
    std::vector<std::pair<std::size_t, float>> cuts(int node) const {
        const Node& n = nodes[static_cast<std::size_t>(node)];
        std::vector<std::pair<std::size_t, float>> all;
        if (n.left >= 0) {
            for (const auto& [left_size, left_cost] : cuts(n.left)) {
                for (const auto& [right_size, right_cost] : cuts(n.right)) {
                    if (left_size + right_size <= 8) {
                        all.emplace_back(left_size + right_size, left_cost + right_cost);
                    }
                }
            }
        }
        // As one child: of a leaf its cost, of an inner node the least of a wide node here.
        float best = n.left < 0 ? n.visits : std::numeric_limits<float>::infinity();
        for (const auto& [size, cost] : all) best = std::min(best, n.visits + cost);
        all.emplace_back(1, best);
        return all;
    }
    /// What the plan's own cut of `node` costs.
    float planned_cost(int node, std::uint32_t most) const {
        const Node& n = nodes[static_cast<std::size_t>(node)];
        if (n.left < 0) return n.visits;
        const CutShare share = most > 1 ? share_of(n.planned.plan, most) : CutShare{0, 1};
        if (share.used == 1) {
            const CutShare wide = share_of(n.planned.plan, 8);
            return n.visits + planned_cost(n.left, wide.left) + planned_cost(n.right, wide.used - wide.left);
        }
        return planned_cost(n.left, share.left) + planned_cost(n.right, share.used - share.left);
    }
};

}  // namespace

TEST_CASE("collapse: the plan costs as little as the best of all wide trees", "[bvh]") {
    std::mt19937 random(1);
    for (int round = 0; round < 300; ++round) {
        Tree tree;
        const std::size_t leaves = 2 + static_cast<std::size_t>(round) % 13;
        const int root = tree.grow(leaves, random);
        CAPTURE(round, leaves);
        const float least = tree.least(root);
        CHECK(tree.planned(root).costs[0] == Approx(least));
        CHECK(tree.planned_cost(root, 1) == Approx(least));
    }
}

TEST_CASE("collapse: eight leaves are one node, and nine are two", "[bvh]") {
    for (const std::size_t leaves : {2U, 8U, 9U}) {
        std::mt19937 random(3);
        Tree tree;
        const int root = tree.grow(leaves, random);
        float sum = 0;
        for (const Tree::Node& node : tree.nodes) sum += node.left < 0 ? node.visits : 0;
        sum += tree.nodes[0].visits;
        if (leaves <= 8) {
            CHECK(tree.planned(root).costs[0] == Approx(sum));
        } else {
            CHECK(tree.planned(root).costs[0] > sum);
        }
    }
}
