#include "bench/embree_tree.h"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

#include "bench/embree_scene.h"
#include "bench/statistics.h"
#include "engine/accel/collapse_plan.h"
#include "engine/accel/cut_reference.h"

namespace sahl::bench {
namespace {

struct BvhRelease {
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using EmbreeBvh = std::unique_ptr<std::remove_pointer_t<RTCBVH>, BvhRelease>;

struct Node {
    Bounds bounds;
    Node* children[2];
    std::uint32_t references;  // of a leaf; 0 for others
};

Bounds from_embree(const RTCBounds& b) {
    return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

void* make_node(RTCThreadLocalAllocator allocator, unsigned /*children*/, void* /*user*/) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Node), 16)) Node{empty_bounds(), {}, 0};
}

void set_children(void* node, void** children, unsigned count, void* /*user*/) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<Node*>(node)->children[i] = static_cast<Node*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/) {
    for (unsigned i = 0; i < count; ++i) extend(static_cast<Node*>(node)->bounds, from_embree(*bounds[i]));
}

void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                void* /*user*/) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Node), 16))
        Node{empty_bounds(), {}, static_cast<std::uint32_t>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const RTCBuildPrimitive& p = primitives[i];
        extend(leaf->bounds, {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}});
    }
    return leaf;
}

void to_embree(const VectorBox& box, RTCBounds& out) {
    out = {box.lo[0], box.lo[1], box.lo[2], 0, box.hi[0], box.hi[1], box.hi[2], 0};
}

void split_primitive(const RTCBuildPrimitive* p, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* user) {
    const auto& lowered = *static_cast<const LoweredScene*>(user);
    const TriangleCorners corners{lowered.shape_data.data(), lowered.primitives.data()};
    const VectorBox box{{p->lower_x, p->lower_y, p->lower_z, 0}, {p->upper_x, p->upper_y, p->upper_z, 0}};
    const CutBoxes cut = cut_triangle(corners.of(p->primID), box, static_cast<int>(axis), position);
    to_embree(cut.below, *left);
    to_embree(cut.above, *right);
}

/// The least costs of the wide trees below `node`.
ForestCosts costs_of(const Node& node, double root_area, std::uint64_t& references) {
    const auto visits = static_cast<float>(half_area(node.bounds) / root_area);
    if (node.references > 0) {
        references += node.references;
        return leaf_costs(visits);
    }
    const ForestCosts left = costs_of(*node.children[0], root_area, references);
    return plan_node(visits, left, costs_of(*node.children[1], root_area, references)).costs;
}

}  // namespace

EmbreeTree build_embree_tree(RTCDevice device, const LoweredScene& lowered) {
    const std::size_t size = lowered.build_primitives.size();
    std::vector<RTCBuildPrimitive> primitives(size + size / 3);
    for (const BuildPrimitive& p : lowered.build_primitives) {
        const auto& [lo, hi] = p.bounds;
        primitives[p.id] = {lo[0], lo[1], lo[2], 0, hi[0], hi[1], hi[2], p.id};
    }
    const EmbreeBvh bvh(rtcNewBVH(device));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof arguments;
    arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 60;
    arguments.sahBlockSize = SAHL_BLOCK_WIDTH;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = SAHL_BLOCK_WIDTH;
    arguments.traversalCost = 1;
    arguments.intersectionCost = 1;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = size;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = make_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = make_leaf;
    arguments.splitPrimitive = split_primitive;
    arguments.userPtr = const_cast<LoweredScene*>(&lowered);

    EmbreeTree tree;
    const double start = seconds_now();
    const auto* root = static_cast<const Node*>(rtcBuildBVH(&arguments));
    tree.seconds = seconds_now() - start;
    check_embree(device, "building a tree");
    tree.sah_cost = static_cast<double>(costs_of(*root, half_area(root->bounds), tree.references)[0]);
    return tree;
}

}  // namespace sahl::bench
