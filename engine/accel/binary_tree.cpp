#include "engine/accel/binary_tree.h"

#include <algorithm>
#include <vector>

#include <tbb/task_group.h>

#include "engine/accel/binned_sah.h"
#include "engine/accel/partition.h"

namespace sahl {

namespace {

// Smaller subtrees are one task: a task then takes about a millisecond.
constexpr std::size_t task_size = 1u << 12;

struct Builder {
    std::span<BuildPrimitive> primitives;
    std::span<BuildPrimitive> scratch;
    BinaryNode* nodes;

    std::uint32_t build(std::size_t begin, std::size_t end, std::uint32_t splits_left);
};

bool is_leaf(const SetSummary& summary, std::size_t size) {
    if (size > SAHL_BLOCK_WIDTH) return false;
    const auto kind = std::find(summary.counts.begin(), summary.counts.end(), size);
    return kind != summary.counts.end() &&
           size <= block_width(static_cast<std::size_t>(kind - summary.counts.begin()));
}

// The left half, in whole blocks where there is more than one.
std::size_t balanced_left_size(std::size_t size) {
    const std::size_t half = (size + 1) / 2;
    if (size <= SAHL_BLOCK_WIDTH) return half;
    return (half + SAHL_BLOCK_WIDTH - 1) / SAHL_BLOCK_WIDTH * SAHL_BLOCK_WIDTH;
}

int longest_axis(const Bounds& bounds) {
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (bounds.hi[axis] - bounds.lo[axis] > bounds.hi[longest] - bounds.lo[longest]) longest = axis;
    }
    return longest;
}

// Why depth is bounded. Claim: a set that may still be split `splits_left` times has at most
// 2^splits_left primitives. It holds at the root: SAHL_MAX_PRIMITIVES < 2^27 and
// SAHL_MAX_TREE_DEPTH >= 27. It goes down: find_split() gives no side of more than
// 2^(splits_left - 1); where it finds nothing, neither side of a balanced cut is larger than
// (size + 1) / 2 <= 2^(splits_left - 1), and rounding that up to a multiple of 4 = 2^2 cannot pass
// 2^(splits_left - 1) either, as splits_left >= 3 for the sizes above 4 that are rounded. At
// splits_left = 0 a set has one primitive, which is a leaf whatever its kind.
std::uint32_t Builder::build(std::size_t begin, std::size_t end, std::uint32_t splits_left) {
    const auto set = primitives.subspan(begin, end - begin);
    const SetSummary summary = summarise(set);
    if (is_leaf(summary, set.size())) return binary_leaf;

    const Split split = find_split(set, summary, std::size_t{1} << (splits_left - 1));
    std::size_t left_size = balanced_left_size(set.size());
    if (split.found()) {
        left_size = partition(set, scratch.empty() ? scratch : scratch.subspan(begin, set.size()), split);
    } else {
        partition_by_rank(set, longest_axis(summary.centroids.bounds()), left_size);
    }

    const std::size_t middle = begin + left_size;
    BinaryNode& node = nodes[middle];
    node.bounds = summary.box.bounds();
    if (set.size() < task_size) {
        node.left = build(begin, middle, splits_left - 1);
        node.right = build(middle, end, splits_left - 1);
    } else {
        tbb::task_group tasks;
        tasks.run([&] { node.left = build(begin, middle, splits_left - 1); });
        node.right = build(middle, end, splits_left - 1);
        tasks.wait();
    }
    return static_cast<std::uint32_t>(middle);
}

}  // namespace

BinaryTree build_binary_tree(std::span<BuildPrimitive> primitives) {
    BinaryTree tree;
    tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(primitives.size());
    std::vector<BuildPrimitive> scratch(primitives.size() < parallel_set_size ? 0 : primitives.size());
    Builder builder{primitives, scratch, tree.nodes.get()};
    tree.root = builder.build(0, primitives.size(), SAHL_MAX_TREE_DEPTH);
    return tree;
}

}  // namespace sahl
