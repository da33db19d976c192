#include "engine/accel/binary_tree.h"

#include <algorithm>

#include <tbb/task_group.h>

#include "engine/accel/binned_sah.h"
#include "engine/accel/parallel_chunks.h"
#include "engine/accel/partition.h"
#include "engine/accel/spatial_split.h"

namespace sahl {

namespace {

// Smaller subtrees are one task: a task then takes about a millisecond.
constexpr std::size_t task_size = 1u << 12;

// Of references [begin, end), with room for more up to `limit`.
struct Range {
    std::size_t begin;
    std::size_t end;
    std::size_t limit;

    std::size_t size() const { return end - begin; }
    std::size_t room() const { return limit - end; }
};

struct Subtree {
    std::uint32_t node;  ///< or binary_leaf
    ForestCosts costs;
};

// How much the sides of an object split overlap before a spatial one is tried, of the root's area and of the
// set's. Measured: high with lower values takes up to twice as long for 0.1 % of cost.
struct Effort {
    double overlap_of_root;
    double overlap_of_set;
};
constexpr Effort high_effort{1e-4, 0.2};
constexpr Effort fast_effort{1e-2, 0.3};

struct Builder {
    BinaryTree& tree;
    const TriangleCorners& corners;
    BuildQuality quality;
    double root_area;
    bool cut;  ///< whether triangles may be cut

    Subtree build(const Range& range, const SetSummary& summary, std::uint32_t splits_left) const;

private:
    float visits(const VectorBox& box) const;
    std::span<BuildPrimitive> references(const Range& range) const {
        return {tree.references.data() + range.begin, range.size()};
    }
    SideSizes part(const Range& range, const SetSummary& summary, std::size_t max_side) const;
    bool is_worth_a_try(const ObjectSplit& split, const VectorBox& set) const;
    std::size_t room_of_left(const Range& range, const SideSizes& sides) const;
    void move_up(const Range& range, std::size_t by) const;
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

// Whether the sides of an object split overlap so much that a spatial one may cost less.
bool Builder::is_worth_a_try(const ObjectSplit& split, const VectorBox& set) const {
    const VectorBox overlap = intersection(split.left, split.right);
    if (is_empty(overlap)) return false;
    const Effort& effort = quality == BuildQuality::fast ? fast_effort : high_effort;
    const double area = half_area(overlap);
    return area > effort.overlap_of_root * root_area && area > effort.overlap_of_set * half_area(set);
}

// The root's box where nothing has an area.
float Builder::visits(const VectorBox& box) const {
    return root_area > 0 ? static_cast<float>(half_area(box) / root_area) : 1.0F;
}

// Parts the references of `range`, which may become more, in two.
SideSizes Builder::part(const Range& range, const SetSummary& summary, std::size_t max_side) const {
    const auto set = references(range);
    const ObjectSplit split = find_object_split(set, summary, max_side, quality);
    if (cut && range.room() > 0 && split.found() && is_worth_a_try(split, summary.box)) {
        const SpatialSplit spatial =
            find_spatial_split(set, corners, summary, max_side, range.size() + range.room());
        if (spatial.border.cost < split.border.cost) {
            const SideSizes sides =
                apply(spatial, references({range.begin, range.limit, range.limit}), set.size(), corners);
            if (sides.left > 0 && sides.right > 0) return sides;
            const auto parted =
                references({range.begin, range.begin + sides.left + sides.right, range.limit});
            const std::size_t left = balanced_left_size(parted.size());
            partition_by_rank(parted, summary.centroids.longest_axis(), left);
            return {left, parted.size() - left};
        }
    }
    std::size_t left = balanced_left_size(set.size());
    if (split.found()) {
        left = partition(set, [&](const BuildPrimitive& reference) { return split.goes_left(reference); });
    } else {
        partition_by_rank(set, summary.centroids.longest_axis(), left);
    }
    return {left, set.size() - left};
}

// Shares what room is left between the sides by the areas of their references' boxes, as large ones are those
// that will be cut. In 2^-32 of the root's area: sums of whole numbers do not depend on their order.
std::size_t Builder::room_of_left(const Range& range, const SideSizes& sides) const {
    const std::size_t room = range.room();
    if (room == 0 || root_area == 0) return 0;
    const auto area_of = [&](std::size_t begin, std::size_t end) {
        std::uint64_t area = 0;
        for (std::size_t i = begin; i < end; ++i) {
            area += static_cast<std::uint64_t>(half_area(box_of(tree.references[i])) / root_area * 0x1p32);
        }
        return area;
    };
    const std::size_t middle = range.begin + sides.left;
    const std::uint64_t left = sum_chunks(range.begin, middle, area_of);
    const std::uint64_t right = sum_chunks(middle, range.end, area_of);
    if (left + right == 0) return room * sides.left / range.size();
    return static_cast<std::size_t>(static_cast<double>(room) * static_cast<double>(left) /
                                    static_cast<double>(left + right));
}

// Moves the references of `range` up, in any order.
void Builder::move_up(const Range& range, std::size_t by) const {
    BuildPrimitive* const from = tree.references.data() + range.begin;
    const std::size_t moved = std::min(by, range.size());
    BuildPrimitive* const to = tree.references.data() + range.end + by - moved;
    for_chunks(moved,
               [&](std::size_t begin, std::size_t end) { std::copy(from + begin, from + end, to + begin); });
}

// Why depth is bounded. Claim: a set that may still be split `splits_left` times has at most
// 2^splits_left references. It holds at the root: SAHL_MAX_PRIMITIVES < 2^27 and
// SAHL_MAX_TREE_DEPTH >= 27. It goes down: no split that is found has a side of more than
// 2^(splits_left - 1); where none is found, neither side of a balanced cut is larger than
// (size + 1) / 2 <= 2^(splits_left - 1), and rounding that up to a multiple of 4 = 2^2 cannot pass
// 2^(splits_left - 1) either, as splits_left >= 3 for the sizes above 4 that are rounded. (A spatial split
// that leaves a side empty leaves no more than 2^(splits_left - 1) references in all.) At splits_left = 0 a
// set has one reference, which is a leaf whatever its kind.
Subtree Builder::build(const Range& range, const SetSummary& summary, std::uint32_t splits_left) const {
    if (is_leaf(summary, range.size())) {
        const std::uint32_t kind = tree.references[range.begin].kind;
        const float price = static_cast<float>(block_costs[kind]) / node_visit_cost;
        return {binary_leaf | static_cast<std::uint32_t>(range.size()),
                leaf_costs(price * visits(summary.box))};
    }
    const SideSizes sides = part(range, summary, std::size_t{1} << (splits_left - 1));

    const std::size_t middle = range.begin + sides.left;
    const std::size_t end = middle + sides.right;
    const std::size_t left_room = room_of_left({range.begin, end, range.limit}, sides);
    if (left_room > 0) move_up({middle, end, range.limit}, left_room);
    const Range left_range{range.begin, middle, middle + left_room};
    const Range right_range{middle + left_room, end + left_room, range.limit};

    Subtree left, right;
    const auto build_left = [&] {
        left = build(left_range, summarise(references(left_range)), splits_left - 1);
    };
    const auto build_right = [&] {
        right = build(right_range, summarise(references(right_range)), splits_left - 1);
    };
    if (range.size() < task_size) {
        build_left();
        build_right();
    } else {
        tbb::task_group tasks;
        tasks.run(build_left);
        build_right();
        tasks.wait();
    }
    const PlannedNode planned = plan_node(visits(summary.box), left.costs, right.costs);
    tree.nodes[right_range.begin] = {summary.box.bounds(), left.node, right.node, planned.plan, {}};
    return {static_cast<std::uint32_t>(right_range.begin), planned.costs};
}

// Whether cuts are exact: see cut_triangle().
bool can_be_cut(const Bounds& bounds) {
    return std::all_of(bounds.lo, bounds.lo + 3, [](float x) { return x > -1e30F; }) &&
           std::all_of(bounds.hi, bounds.hi + 3, [](float x) { return x < 1e30F; });
}

}  // namespace

BinaryTree build_binary_tree(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners,
                             BuildQuality quality) {
    const std::size_t size = primitives.size();
    const SetSummary summary = summarise(primitives);
    BinaryTree tree;
    tree.references = std::move(primitives);
    if (!corners.empty()) tree.references.resize(most_references(size));
    tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(tree.references.size());
    tree.bounds = summary.box.bounds();
    const Builder builder{tree, corners, quality, half_area(tree.bounds),
                          !corners.empty() && can_be_cut(tree.bounds)};
    tree.root = builder.build({0, size, tree.references.size()}, summary, SAHL_MAX_TREE_DEPTH).node;
    return tree;
}

}  // namespace sahl
