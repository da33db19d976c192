#include "engine/accel/wide_collapse.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include <tbb/task_group.h>

#include "engine/accel/cost_model.h"
#include "engine/accel/slot_order.h"
#include "engine/accel/vector_box.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

// Subtrees of as many leaves are tasks of their own.
constexpr std::uint32_t leaves_a_task = 1u << 10;

bool is_leaf(std::uint32_t child) { return (child & binary_leaf) != 0; }

struct Children {
    std::array<std::uint32_t, wide_width> child{};
    std::size_t size = 0;
};

// What a wide tree has.
struct WideExtent {
    std::uint32_t nodes = 0;
    LeafExtent below{};

    void add(const WideExtent& other) {
        nodes += other.nodes;
        below.leaves += other.below.leaves;
        below.lines += other.below.lines;
    }
};

// What the statistics of a subtree of wide nodes are summed up from.
struct Placed {
    double cost = 0;  // of its nodes and leaves, by the visits of a ray that meets the root
    std::uint64_t references = 0;
    int depth = 0;

    void add(const Placed& below) {
        cost += below.cost;
        references += below.references;
        depth = std::max(depth, below.depth);
    }
};

struct Collapse {
    BinaryTree& tree;
    Bvh& bvh;
    double root_area;

    void cut(std::uint32_t subtree, std::uint32_t most, Children& children) const;
    void merge(Children& children) const;
    Children open(std::uint32_t node) const;
    std::uint32_t kind_of(std::uint32_t leaf) const { return tree.references[unpack_leaf(leaf).begin].kind; }
    Bounds bounds_of(std::uint32_t subtree) const;
    void measure(std::uint32_t node) const;
    WideExtent extent_of(std::uint32_t subtree) const;
    double visits(const Bounds& box) const { return root_area > 0 ? half_area(box) / root_area : 1.0; }
    Placed place_node(std::uint32_t parent, double visits_of_parent, const WideExtent& before) const;
    const BvhLeaf& place_leaf(const BinaryLeaf& leaf, const WideExtent& before) const;

    // Calls work(0), ... work(size - 1) for the children of `parent`, as tasks if it is large.
    template <class Work>
    void for_children(std::uint32_t parent, std::size_t size, const Work& work) const {
        if (is_leaf(parent) || tree.nodes[parent].below.leaves < leaves_a_task) {
            for (std::size_t i = 0; i < size; ++i) work(i);
            return;
        }
        tbb::task_group tasks;
        for (std::size_t i = 0; i < size; ++i) tasks.run([&work, i] { work(i); });
        tasks.wait();
    }
};

// Appends `subtree` as at most `most` children.
void Collapse::cut(std::uint32_t subtree, std::uint32_t most, Children& children) const {
    if (!is_leaf(subtree) && most > 1) {
        const BinaryNode& node = tree.nodes[subtree];
        const CutShare share = share_of(node.plan, most);
        if (share.used > 1) {
            cut(node.left, share.left, children);
            cut(node.right, share.used - share.left, children);
            return;
        }
    }
    children.child[children.size++] = subtree;
}

// Where a child's own children find room beside the others, the plan has them there, but for what rounding
// hides; most_nodes() relies on it.
void Collapse::merge(Children& children) const {
    for (std::size_t i = 0; i < children.size;) {
        const std::uint32_t child = children.child[i];
        if (is_leaf(child) || children.size - 1 + tree.nodes[child].wide_children > wide_width) {
            ++i;
            continue;
        }
        const Children below = open(child);
        children.child[i] = below.child[0];
        for (std::size_t k = 1; k < below.size; ++k) children.child[children.size++] = below.child[k];
    }
}

// The children of `subtree` as a wide node, once those below are measured.
Children Collapse::open(std::uint32_t subtree) const {
    Children children;
    cut(subtree, wide_width, children);
    merge(children);
    return children;
}

WideExtent Collapse::extent_of(std::uint32_t subtree) const {
    if (is_leaf(subtree)) return {0, {1, block_lines(kind_of(subtree))}};
    return {tree.nodes[subtree].wide_nodes, tree.nodes[subtree].below};
}

// Counts the wide nodes of `node`, which becomes one, and of those below it.
void Collapse::measure(std::uint32_t node) const {
    Children children;
    cut(node, wide_width, children);
    for_children(node, children.size, [&](std::size_t i) {
        if (!is_leaf(children.child[i])) measure(children.child[i]);
    });
    merge(children);
    std::uint32_t nodes = 1;
    for (std::size_t i = 0; i < children.size; ++i) {
        if (!is_leaf(children.child[i])) nodes += tree.nodes[children.child[i]].wide_nodes;
    }
    tree.nodes[node].wide_children = static_cast<std::uint32_t>(children.size);
    tree.nodes[node].wide_nodes = nodes;
}

Bounds Collapse::bounds_of(std::uint32_t subtree) const {
    if (!is_leaf(subtree)) return tree.nodes[subtree].bounds;
    VectorBox box;
    const auto [begin, size] = unpack_leaf(subtree);
    for (std::uint32_t i = begin; i < begin + size; ++i) box.extend(box_of(tree.references[i]));
    return box.bounds();
}

const BvhLeaf& Collapse::place_leaf(const BinaryLeaf& leaf, const WideExtent& before) const {
    BvhLeaf& block = bvh.leaves[before.below.leaves];
    block.count = 0;
    block.kind = tree.references[leaf.begin].kind;
    const std::uint32_t end = leaf.begin + leaf.size;
    for (std::uint32_t i = leaf.begin; i < end; ++i) block.ids[block.count++] = tree.references[i].id;
    std::sort(block.ids, block.ids + block.count);
    block.count = static_cast<std::uint32_t>(std::unique(block.ids, block.ids + block.count) - block.ids);
    std::fill(block.ids + block.count, std::end(block.ids), 0U);
    return block;
}

std::uint32_t leaf_child(const BvhLeaf& leaf, const WideExtent& before) {
    const std::uint32_t place = leaf.kind == SAHL_KIND_INSTANCE ? leaf.ids[0] : before.below.lines;
    return SAHL_CHILD_LEAF | leaf.kind << SAHL_CHILD_KIND_SHIFT | place;
}

device::BvhNode empty_node() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    device::BvhNode node{};
    for (std::size_t slot = 0; slot < wide_width; ++slot) {
        node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = infinity;
        node.hi_x[slot] = node.hi_y[slot] = node.hi_z[slot] = -infinity;
        node.child[slot] = 0xffffffffu;
    }
    return node;
}

// Writes the wide tree of `parent`, which a ray visits so often, behind all that is `before` it.
Placed Collapse::place_node(std::uint32_t parent, double visits_of_parent, const WideExtent& before) const {
    const Children children = open(parent);
    std::array<Bounds, wide_width> boxes;
    for (std::size_t i = 0; i < children.size; ++i) boxes[i] = bounds_of(children.child[i]);
    const std::array<int, wide_width> slot_of = assign_slots(std::span(boxes).first(children.size));
    std::array<std::size_t, wide_width> child_in{};
    for (std::size_t i = 0; i < wide_width; ++i) child_in[static_cast<std::size_t>(slot_of[i])] = i;

    device::BvhNode& node = bvh.nodes[before.nodes];
    node = empty_node();
    std::array<WideExtent, wide_width> before_child;
    WideExtent next = before;
    ++next.nodes;
    for (const std::size_t child : child_in) {
        if (child >= children.size) continue;
        before_child[child] = next;
        next.add(extent_of(children.child[child]));
    }
    std::array<Placed, wide_width> placed;
    for_children(parent, children.size, [&](std::size_t i) {
        const std::uint32_t child = children.child[i];
        const auto slot = static_cast<std::size_t>(slot_of[i]);
        node.lo_x[slot] = boxes[i].lo[0];
        node.lo_y[slot] = boxes[i].lo[1];
        node.lo_z[slot] = boxes[i].lo[2];
        node.hi_x[slot] = boxes[i].hi[0];
        node.hi_y[slot] = boxes[i].hi[1];
        node.hi_z[slot] = boxes[i].hi[2];
        if (is_leaf(child)) {
            const BvhLeaf& leaf = place_leaf(unpack_leaf(child), before_child[i]);
            node.child[slot] = leaf_child(leaf, before_child[i]);
            placed[i] = {visits(boxes[i]) * block_costs[leaf.kind], leaf.count, 0};
        } else {
            node.child[slot] = before_child[i].nodes;
            placed[i] = place_node(child, visits(boxes[i]), before_child[i]);
        }
    });
    Placed whole{visits_of_parent * node_visit_cost, 0, 0};
    for (const Placed& below : std::span(placed).first(children.size)) whole.add(below);
    ++whole.depth;
    return whole;
}

}  // namespace

std::uint32_t block_lines(std::uint32_t kind) {
    constexpr std::array<std::size_t, kind_count> bytes{
        sizeof(device::TriangleBlock), sizeof(device::SphereBlock),  sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::PolygonBlock), sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::QuadricBlock), 0};
    return static_cast<std::uint32_t>(bytes.at(kind) / SAHL_LEAF_LINE_BYTES);
}

std::uint32_t addressable_lines(std::uint64_t lines) {
    if (lines <= SAHL_CHILD_OFFSET_MASK + 1) return static_cast<std::uint32_t>(lines);
    throw Error(ExitCode::scene,
                "the scene's primitives need more than " + std::to_string(SAHL_CHILD_OFFSET_MASK + 1) +
                    " lines of 64 bytes in the acceleration structure, the most it can address: render fewer "
                    "primitives at a time");
}

Bvh empty_bvh() {
    Bvh bvh;
    bvh.nodes.push_back(empty_node());
    bvh.statistics.nodes = 1;
    bvh.statistics.depth = 1;
    bvh.statistics.sah_cost = 1;
    return bvh;
}

Bvh collapse(BinaryTree& tree) {
    Bvh bvh;
    const Collapse step{tree, bvh, half_area(tree.bounds)};
    if (!is_leaf(tree.root)) step.measure(tree.root);
    const WideExtent whole = step.extent_of(tree.root);
    bvh.leaf_lines = addressable_lines(whole.below.lines);
    bvh.nodes.resize(std::max(whole.nodes, 1u));
    bvh.leaves.resize(whole.below.leaves);
    const Placed placed = step.place_node(tree.root, 1, {});
    bvh.bounds = tree.bounds;
    bvh.statistics.nodes = bvh.nodes.size();
    bvh.statistics.leaves = bvh.leaves.size();
    bvh.statistics.references = placed.references;
    bvh.statistics.depth = placed.depth;
    bvh.statistics.sah_cost = placed.cost / node_visit_cost;
    bvh.statistics.leaf_fill =
        static_cast<double>(placed.references) / static_cast<double>(bvh.leaves.size());
    return bvh;
}

}  // namespace sahl
