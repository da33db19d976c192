#include "engine/accel/binary_tree.h"

#include <algorithm>

#include <tbb/task_group.h>

#include "engine/accel/binned_sah.h"
#include "engine/accel/parallel_chunks.h"
#include "engine/accel/partition.h"
#include "engine/accel/pre_split.h"
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

// How much the sides of an object split overlap before a spatial one is tried, of the root's area and of the
// set's. Measured: with lower values it takes up to twice as long for 0.1 % of cost.
constexpr double overlap_of_root = 1e-4;
constexpr double overlap_of_set = 0.2;

struct Builder {
    BinaryTree& tree;
    const TriangleCorners& corners;
    BuildQuality quality;
    double root_area;

    // The nodes of a small set are taken from `next` on, see BinaryNode.
    BinarySubtree build(const Range& range, const SetSummary& summary, std::uint32_t splits_left,
                        std::uint32_t& next) const;

private:
    float visits(const VectorBox& box) const;
    std::span<BuildPrimitive> references(const Range& range) const {
        return {tree.references.data() + range.begin, range.size()};
    }
    Parted part(const Range& range, const SetSummary& summary, std::size_t max_side) const;
    bool is_worth_a_try(const ObjectSplit& split, const VectorBox& set) const;
    std::size_t room_of_left(const Range& range, std::size_t left_size) const;
    void move_up(const Range& range, std::size_t by) const;
};

bool is_leaf(const SetSummary& summary) {
    return !summary.mixed() && summary.size <= block_width(summary.first_kind());
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
    const double area = half_area(overlap);
    return area > overlap_of_root * root_area && area > overlap_of_set * half_area(set);
}

// The root's box where nothing has an area.
float Builder::visits(const VectorBox& box) const {
    return root_area > 0 ? static_cast<float>(half_area(box) / root_area) : 1.0F;
}

// Parts the references of `range`, which may become more, in two.
Parted Builder::part(const Range& range, const SetSummary& summary, std::size_t max_side) const {
    const auto set = references(range);
    const int longest = summary.centroids.longest_axis();
    // In two blocks however they are shared: halves cost up to 1 % more and are found sooner, by 4 % of all
    // time.
    if (quality == BuildQuality::fast && !summary.mixed() && set.size() <= 2 * SAHL_BLOCK_WIDTH) {
        return partition_by_rank(set, longest, balanced_left_size(set.size()));
    }
    const ObjectSplit split = find_object_split(set, summary, max_side, quality);
    if (range.room() > 0 && split.found() && is_worth_a_try(split, summary.box)) {
        const SpatialSplit spatial =
            find_spatial_split(set, corners, summary, max_side, range.size() + range.room());
        if (spatial.border.cost < split.border.cost) {
            const Parted sides =
                apply(spatial, references({range.begin, range.limit, range.limit}), set.size(), corners);
            const std::size_t size = sides.left.size + sides.right.size;
            if (sides.left.size > 0 && sides.right.size > 0) return sides;
            return partition_by_rank(references({range.begin, range.begin + size, range.limit}), longest,
                                     balanced_left_size(size));
        }
    }
    if (!split.found()) return partition_by_rank(set, longest, balanced_left_size(set.size()));
    if (split.border.axis == ObjectSplit::by_kind) {
        return partition(set, [kind = static_cast<std::uint32_t>(split.border.position)](
                                  const BuildPrimitive& reference) { return reference.kind < kind; });
    }
    return partition(set, split.goes_left());
}

// Shares what room is left between the sides by the areas of their references' boxes, as large ones are those
// that will be cut. In 2^-32 of the root's area: sums of whole numbers do not depend on their order.
std::size_t Builder::room_of_left(const Range& range, std::size_t left_size) const {
    const std::size_t room = range.room();
    if (room == 0 || root_area == 0) return 0;
    const auto area_of = [&](std::size_t begin, std::size_t end) {
        std::uint64_t area = 0;
        for (std::size_t i = begin; i < end; ++i) {
            area += static_cast<std::uint64_t>(half_area(box_of(tree.references[i])) / root_area * 0x1p32);
        }
        return area;
    };
    const std::size_t middle = range.begin + left_size;
    const std::uint64_t left = sum_chunks(range.begin, middle, area_of);
    const std::uint64_t right = sum_chunks(middle, range.end, area_of);
    if (left + right == 0) return room * left_size / range.size();
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
// 2^(splits_left - 1); where none is, neither side of a balanced cut is larger than
// (size + 1) / 2 <= 2^(splits_left - 1), and rounding that up to a multiple of 4 = 2^2 cannot pass
// 2^(splits_left - 1) either, as splits_left >= 3 for the sizes above 4 that are rounded. (A spatial split
// that leaves a side empty leaves no more than 2^(splits_left - 1) references in all.) At splits_left = 0 a
// set has one reference, which is a leaf whatever its kind.
BinarySubtree Builder::build(const Range& range, const SetSummary& summary, std::uint32_t splits_left,
                             std::uint32_t& next) const {
    if (is_leaf(summary)) {
        return leaf_subtree(
            {static_cast<std::uint32_t>(range.begin), static_cast<std::uint32_t>(range.size())},
            summary.first_kind(), visits(summary.box));
    }
    const Parted sides = part(range, summary, std::size_t{1} << (splits_left - 1));

    const std::size_t middle = range.begin + sides.left.size;
    const std::size_t end = middle + sides.right.size;
    const std::size_t left_room = room_of_left({range.begin, end, range.limit}, sides.left.size);
    if (left_room > 0) move_up({middle, end, range.limit}, left_room);
    const Range left_range{range.begin, middle, middle + left_room};
    const Range right_range{middle + left_room, end + left_room, range.limit};

    BinarySubtree left, right;
    std::uint32_t index;
    if (range.size() < task_size) {
        index = next++;
        left = build(left_range, sides.left, splits_left - 1, next);
        right = build(right_range, sides.right, splits_left - 1, next);
    } else {
        index = static_cast<std::uint32_t>(right_range.begin);
        tbb::task_group tasks;
        tasks.run([&] {
            std::uint32_t from = static_cast<std::uint32_t>(left_range.begin) + 1;
            left = build(left_range, sides.left, splits_left - 1, from);
        });
        std::uint32_t from = index + 1;
        right = build(right_range, sides.right, splits_left - 1, from);
        tasks.wait();
    }
    return tree.join(index, summary.box.bounds(), visits(summary.box), left, right);
}

// Whether cuts are exact: see cut_triangle().
bool can_be_cut(const Bounds& bounds) {
    return std::all_of(bounds.lo, bounds.lo + 3, [](float x) { return x > -1e30F; }) &&
           std::all_of(bounds.hi, bounds.hi + 3, [](float x) { return x < 1e30F; });
}

}  // namespace

BinarySubtree leaf_subtree(const BinaryLeaf& leaf, std::uint32_t kind, float visits) {
    const float price = static_cast<float>(block_costs[kind]) / node_visit_cost;
    return {pack_leaf(leaf), leaf_costs(price * visits), {1, block_lines(kind)}};
}

BinarySubtree BinaryTree::join(std::uint32_t index, const Bounds& box, float visits,
                               const BinarySubtree& left, const BinarySubtree& right) {
    const auto [costs, plan] = plan_node(visits, left.costs, right.costs);
    const LeafExtent below{left.below.leaves + right.below.leaves, left.below.lines + right.below.lines};
    nodes[index] = {box, left.root, right.root, plan, below, 0, 0};
    return {index, costs, below};
}

BinaryTree build_binary_tree(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners,
                             BuildQuality quality) {
    SetSummary summary = check_and_summarise(primitives);
    BinaryTree tree;
    tree.references = std::move(primitives);
    const bool cut = !corners.empty() && can_be_cut(summary.box.bounds());
    if (cut && quality == BuildQuality::fast) {
        pre_split(tree.references, summary.box, corners);
        if (tree.references.size() > summary.size) summary = summarise(tree.references);
    }
    if (cut && quality == BuildQuality::high) tree.references.resize(most_references(summary.size));
    tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(tree.references.size());
    tree.bounds = summary.box.bounds();
    const Builder builder{tree, corners, quality, half_area(tree.bounds)};
    std::uint32_t next = 1;
    tree.root =
        builder.build({0, summary.size, tree.references.size()}, summary, SAHL_MAX_TREE_DEPTH, next).root;
    return tree;
}

}  // namespace sahl
