#include "engine/accel/wide_collapse.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include <tbb/task_group.h>

#include "engine/accel/cost_model.h"
#include "engine/accel/slot_order.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

// Subtrees of as many references are tasks of their own.
constexpr std::size_t references_a_task = 1u << 12;

// A subtree of the binary tree: `node` is an index or a leaf. Its references begin at `begin`, and all
// others' before that or at `limit` or behind.
struct BinarySubtree {
    std::uint32_t node = binary_leaf;
    std::uint32_t begin = 0;
    std::uint32_t limit = 0;

    bool is_leaf() const { return (node & binary_leaf) != 0; }
};

struct Children {
    std::array<BinarySubtree, wide_width> subtrees{};
    std::size_t size = 0;
};

void add(WideExtent& sum, const WideExtent& other) {
    sum.nodes += other.nodes;
    sum.leaves += other.leaves;
    sum.lines += other.lines;
}

struct Collapse {
    BinaryTree& tree;
    Bvh& bvh;

    void cut(const BinarySubtree& subtree, std::uint32_t most, Children& children) const;
    Children open(const BinarySubtree& parent) const;
    std::uint32_t kind_of(const BinarySubtree& leaf) const { return tree.references[leaf.begin].kind; }
    Bounds bounds_of(const BinarySubtree& subtree) const;
    void measure(const BinarySubtree& node) const;
    WideExtent extent_of(const BinarySubtree& subtree) const;
    void place_node(const BinarySubtree& parent, const WideExtent& before) const;
    std::uint32_t place_leaf(const BinarySubtree& leaf, const WideExtent& before) const;
};

// Calls work(0), ... work(size - 1) for the children of `parent`, as tasks if it is large.
template <class Work>
void for_children(const BinarySubtree& parent, std::size_t size, const Work& work) {
    if (parent.limit - parent.begin < references_a_task) {
        for (std::size_t i = 0; i < size; ++i) work(i);
        return;
    }
    tbb::task_group tasks;
    for (std::size_t i = 0; i < size; ++i) tasks.run([&work, i] { work(i); });
    tasks.wait();
}

// Appends `subtree` as at most `most` children.
void Collapse::cut(const BinarySubtree& subtree, std::uint32_t most, Children& children) const {
    if (!subtree.is_leaf() && most > 1) {
        const BinaryNode& node = tree.nodes[subtree.node];
        const CutShare share = share_of(node.plan, most);
        if (share.used > 1) {
            cut({node.left, subtree.begin, subtree.node}, share.left, children);
            cut({node.right, subtree.node, subtree.limit}, share.used - share.left, children);
            return;
        }
    }
    children.subtrees[children.size++] = subtree;
}

// The children of `parent` as a wide node, once those below are measured. Where a child's own children find
// room beside the others, the plan has them there, but for what rounding hides; most_nodes() relies on it.
Children Collapse::open(const BinarySubtree& parent) const {
    Children children;
    cut(parent, wide_width, children);
    for (std::size_t i = 0; i < children.size;) {
        const BinarySubtree child = children.subtrees[i];
        if (child.is_leaf() || children.size - 1 + tree.nodes[child.node].extent.children > wide_width) {
            ++i;
            continue;
        }
        const Children below = open(child);
        children.subtrees[i] = below.subtrees[0];
        for (std::size_t k = 1; k < below.size; ++k) children.subtrees[children.size++] = below.subtrees[k];
    }
    return children;
}

WideExtent Collapse::extent_of(const BinarySubtree& subtree) const {
    return subtree.is_leaf() ? WideExtent{1, 0, 1, block_lines(kind_of(subtree))}
                             : tree.nodes[subtree.node].extent;
}

// Finds the extents of `node`, which becomes a wide one, and of all wide ones below it.
void Collapse::measure(const BinarySubtree& node) const {
    Children planned;
    cut(node, wide_width, planned);
    for_children(node, planned.size, [&](std::size_t i) {
        if (!planned.subtrees[i].is_leaf()) measure(planned.subtrees[i]);
    });
    const Children children = open(node);
    WideExtent sum{static_cast<std::uint32_t>(children.size), 1, 0, 0};
    for (std::size_t i = 0; i < children.size; ++i) add(sum, extent_of(children.subtrees[i]));
    tree.nodes[node.node].extent = sum;
}

Bounds Collapse::bounds_of(const BinarySubtree& subtree) const {
    if (!subtree.is_leaf()) return tree.nodes[subtree.node].bounds;
    Bounds bounds = empty_bounds();
    const std::uint32_t end = subtree.begin + (subtree.node & ~binary_leaf);
    for (std::uint32_t i = subtree.begin; i < end; ++i) extend(bounds, tree.references[i].bounds);
    return bounds;
}

std::uint32_t Collapse::place_leaf(const BinarySubtree& leaf, const WideExtent& before) const {
    BvhLeaf& block = bvh.leaves[before.leaves];
    block.kind = kind_of(leaf);
    const std::uint32_t end = leaf.begin + (leaf.node & ~binary_leaf);
    for (std::uint32_t i = leaf.begin; i < end; ++i) block.ids[block.count++] = tree.references[i].id;
    std::sort(block.ids, block.ids + block.count);
    block.count = static_cast<std::uint32_t>(std::unique(block.ids, block.ids + block.count) - block.ids);
    std::fill(block.ids + block.count, std::end(block.ids), 0U);
    const std::uint32_t place =
        block.kind == SAHL_KIND_INSTANCE ? block.ids[0] : static_cast<std::uint32_t>(before.lines);
    return SAHL_CHILD_LEAF | block.kind << SAHL_CHILD_KIND_SHIFT | place;
}

// Writes the wide tree of `parent` behind all that is `before` it.
void Collapse::place_node(const BinarySubtree& parent, const WideExtent& before) const {
    const Children children = open(parent);
    std::array<Bounds, wide_width> boxes;
    for (std::size_t i = 0; i < children.size; ++i) boxes[i] = bounds_of(children.subtrees[i]);
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
        add(next, extent_of(children.subtrees[child]));
    }
    for_children(parent, children.size, [&](std::size_t i) {
        const BinarySubtree& child = children.subtrees[i];
        const auto slot = static_cast<std::size_t>(slot_of[i]);
        node.lo_x[slot] = boxes[i].lo[0];
        node.lo_y[slot] = boxes[i].lo[1];
        node.lo_z[slot] = boxes[i].lo[2];
        node.hi_x[slot] = boxes[i].hi[0];
        node.hi_y[slot] = boxes[i].hi[1];
        node.hi_z[slot] = boxes[i].hi[2];
        node.child[slot] = child.is_leaf() ? place_leaf(child, before_child[i]) : before_child[i].nodes;
        if (!child.is_leaf()) place_node(child, before_child[i]);
    });
}

}  // namespace

std::uint32_t block_lines(std::uint32_t kind) {
    constexpr std::array<std::size_t, kind_count> bytes{
        sizeof(device::TriangleBlock), sizeof(device::SphereBlock),  sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::PolygonBlock), sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::QuadricBlock), 0};
    return static_cast<std::uint32_t>(bytes.at(kind) / SAHL_LEAF_LINE_BYTES);
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

std::uint32_t addressable_lines(std::uint64_t lines) {
    if (lines <= SAHL_CHILD_OFFSET_MASK + 1) return static_cast<std::uint32_t>(lines);
    throw Error(ExitCode::scene,
                "the scene's primitives need more than " + std::to_string(SAHL_CHILD_OFFSET_MASK + 1) +
                    " lines of 64 bytes in the acceleration structure, the most it can address: render fewer "
                    "primitives at a time");
}

void collapse(BinaryTree& tree, Bvh& bvh) {
    const auto references = static_cast<std::uint32_t>(tree.references.size());
    const Collapse step{tree, bvh};
    const BinarySubtree root{tree.root, 0, references};
    if (!root.is_leaf()) step.measure(root);
    WideExtent whole = step.extent_of(root);
    if (root.is_leaf()) ++whole.nodes;
    bvh.leaf_lines = addressable_lines(whole.lines);
    bvh.nodes.resize(whole.nodes);
    bvh.leaves.resize(whole.leaves);
    step.place_node(root, {});
}

}  // namespace sahl
