#include "engine/accel/wide_collapse.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include "engine/accel/cost_model.h"
#include "engine/accel/slot_order.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

constexpr std::size_t width = 8;

// A subtree of the binary tree: `node` is an index or binary_leaf.
struct Subtree {
    std::uint32_t node;
    std::uint32_t begin;
    std::uint32_t end;
    Bounds bounds;
};

struct Children {
    std::array<Subtree, width> subtrees{};
    std::array<Bounds, width> boxes{};
    std::size_t size = 0;
};

struct Collapse {
    const BinaryTree& tree;
    std::span<const BuildPrimitive> primitives;
    Bvh& bvh;

    Subtree subtree(std::uint32_t node, std::uint32_t begin, std::uint32_t end) const;
    Children open(const Subtree& parent) const;
    std::uint32_t add_leaf(const Subtree& leaf) const;
    std::uint32_t add_node(const Children& children) const;
};

Subtree Collapse::subtree(std::uint32_t node, std::uint32_t begin, std::uint32_t end) const {
    if (node != binary_leaf) return {node, begin, end, tree.nodes[node].bounds};
    Subtree leaf{node, begin, end, empty_bounds()};
    for (std::uint32_t i = begin; i < end; ++i) extend(leaf.bounds, primitives[i].bounds);
    return leaf;
}

Children Collapse::open(const Subtree& parent) const {
    Children children;
    std::array<double, width> areas{};
    const auto put = [&](std::size_t place, const Subtree& child) {
        children.subtrees[place] = child;
        areas[place] = child.node == binary_leaf ? -1.0 : half_area(child.bounds);
    };
    put(0, parent);
    for (children.size = 1; children.size < width; ++children.size) {
        const auto end = areas.begin() + static_cast<std::ptrdiff_t>(children.size);
        const auto place = static_cast<std::size_t>(std::max_element(areas.begin(), end) - areas.begin());
        const Subtree opened = children.subtrees[place];
        if (opened.node == binary_leaf) break;
        const BinaryNode& node = tree.nodes[opened.node];
        put(place, subtree(node.left, opened.begin, opened.node));
        put(children.size, subtree(node.right, opened.node, opened.end));
    }
    for (std::size_t i = 0; i < children.size; ++i) children.boxes[i] = children.subtrees[i].bounds;
    return children;
}

std::uint32_t Collapse::add_leaf(const Subtree& leaf) const {
    const std::uint32_t kind = primitives[leaf.begin].kind;
    BvhLeaf block;
    block.kind = kind;
    for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
        std::uint32_t place = block.count++;
        for (; place > 0 && block.ids[place - 1] > primitives[i].id; --place)
            block.ids[place] = block.ids[place - 1];
        block.ids[place] = primitives[i].id;
    }
    bvh.leaves.push_back(block);
    if (kind == SAHL_KIND_INSTANCE) return SAHL_CHILD_LEAF | kind << SAHL_CHILD_KIND_SHIFT | block.ids[0];
    const std::uint32_t offset = bvh.leaf_lines;
    bvh.leaf_lines = offset_after_block(offset, kind);
    return SAHL_CHILD_LEAF | kind << SAHL_CHILD_KIND_SHIFT | offset;
}

std::uint32_t Collapse::add_node(const Children& children) const {
    const std::size_t index = bvh.nodes.size();
    bvh.nodes.push_back(empty_node());
    const std::array<int, width> slot_of = assign_slots(std::span(children.boxes).first(children.size));
    std::array<std::size_t, width> child_in{};
    for (std::size_t i = 0; i < width; ++i) child_in[static_cast<std::size_t>(slot_of[i])] = i;
    for (std::size_t slot = 0; slot < width; ++slot) {
        if (child_in[slot] >= children.size) continue;
        const Subtree& child = children.subtrees[child_in[slot]];
        const std::uint32_t reference = child.node == binary_leaf ? add_leaf(child) : add_node(open(child));
        device::BvhNode& node = bvh.nodes[index];
        node.lo_x[slot] = child.bounds.lo[0];
        node.lo_y[slot] = child.bounds.lo[1];
        node.lo_z[slot] = child.bounds.lo[2];
        node.hi_x[slot] = child.bounds.hi[0];
        node.hi_y[slot] = child.bounds.hi[1];
        node.hi_z[slot] = child.bounds.hi[2];
        node.child[slot] = reference;
    }
    return static_cast<std::uint32_t>(index);
}

}  // namespace

std::uint32_t block_lines(std::uint32_t kind) {
    constexpr std::array<std::size_t, kind_count> bytes{
        sizeof(device::TriangleBlock), sizeof(device::SphereBlock),  sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::PolygonBlock), sizeof(device::QuadricBlock),
        sizeof(device::QuadricBlock),  sizeof(device::QuadricBlock), 0};
    return static_cast<std::uint32_t>(bytes.at(kind) / SAHL_LEAF_LINE_BYTES);
}

std::uint32_t offset_after_block(std::uint32_t offset, std::uint32_t kind) {
    const std::uint32_t end = offset + block_lines(kind);
    if (end <= SAHL_CHILD_OFFSET_MASK + 1) return end;
    throw Error(ExitCode::scene,
                "the scene's primitives need more than " + std::to_string(SAHL_CHILD_OFFSET_MASK + 1) +
                    " lines of 64 bytes in the acceleration structure, the most it can address: render fewer "
                    "primitives at a time");
}

device::BvhNode empty_node() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    device::BvhNode node{};
    for (std::size_t slot = 0; slot < width; ++slot) {
        node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = infinity;
        node.hi_x[slot] = node.hi_y[slot] = node.hi_z[slot] = -infinity;
        node.child[slot] = 0xffffffffu;
    }
    return node;
}

void collapse(const BinaryTree& tree, std::span<const BuildPrimitive> primitives, Bvh& bvh) {
    // Only what is used of it becomes memory, and none is moved.
    bvh.nodes.reserve(most_nodes(primitives.size()));
    bvh.leaves.reserve(primitives.size());
    const Collapse step{tree, primitives, bvh};
    step.add_node(step.open(step.subtree(tree.root, 0, static_cast<std::uint32_t>(primitives.size()))));
}

}  // namespace sahl
