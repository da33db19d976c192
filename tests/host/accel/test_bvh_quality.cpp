#include <algorithm>
#include <memory>

#include <catch2/catch.hpp>

#include "engine/accel/binary_tree.h"
#include "engine/accel/bvh.h"
#include "engine/accel/wide_collapse.h"
#include "tests/host/accel/boxes.h"
#include "tests/host/accel/tree_walk.h"

using namespace sahl;
using namespace sahl::test;

namespace {

// The tree to beat: halves by centroid along the longest axis.
struct MedianTree {
    BinaryTree tree;

    BinarySubtree split(std::size_t begin, std::size_t end);
};

BinarySubtree MedianTree::split(std::size_t begin, std::size_t end) {
    const auto first = tree.references.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = tree.references.begin() + static_cast<std::ptrdiff_t>(end);
    const bool one_kind = std::all_of(first, last, [&](const auto& p) { return p.kind == first->kind; });
    const std::size_t most = first->kind == SAHL_KIND_INSTANCE ? 1 : 4;
    Bounds bounds = empty_bounds();
    for (auto p = first; p != last; ++p) extend(bounds, p->bounds);
    const float area = static_cast<float>(half_area(bounds));
    if (end - begin <= most && one_kind) {
        return leaf_subtree({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)},
                            first->kind, area);
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        if (bounds.hi[k] - bounds.lo[k] > bounds.hi[axis] - bounds.lo[axis]) axis = k;
    }
    std::sort(first, last, [&](const auto& a, const auto& b) {
        return a.bounds.lo[axis] + a.bounds.hi[axis] < b.bounds.lo[axis] + b.bounds.hi[axis];
    });
    const std::size_t middle = (begin + end) / 2;
    const BinarySubtree left = split(begin, middle);
    return tree.join(static_cast<std::uint32_t>(middle), bounds, area, left, split(middle, end));
}

double median_tree_cost(const std::vector<BuildPrimitive>& primitives) {
    MedianTree median;
    median.tree.references = primitives;
    median.tree.nodes = std::make_unique<BinaryNode[]>(primitives.size());
    median.tree.root = median.split(0, primitives.size()).root;
    median.tree.bounds = empty_bounds();
    for (const BuildPrimitive& primitive : primitives) extend(median.tree.bounds, primitive.bounds);
    const Bvh bvh = collapse(median.tree);
    const TreeFacts facts = walk(bvh, primitives);
    REQUIRE(facts.fault == "");
    return facts.sah_cost;
}

}  // namespace

TEST_CASE("the cost of eight separate blocks is in closed form", "[bvh]") {
    std::vector<BuildPrimitive> primitives;
    for (std::uint32_t id = 0; id < 32; ++id) {
        const auto at = [&](std::uint32_t bit) { return (id / 4 >> bit & 1u) != 0 ? 9.0f : 0.0f; };
        primitives.push_back({cube(at(0), at(1), at(2), 1), SAHL_KIND_SOLID_CONE, id});
    }
    const Bvh bvh = build_bvh(primitives);
    REQUIRE(bvh.leaves.size() == 8);
    REQUIRE(bvh.nodes.size() == 1);
    // The root, and eight blocks of solid cones, of weight 2 and 1/100 of the root's area.
    CHECK(bvh.statistics.sah_cost == Approx(1 + 8 * 2 * 0.01));
    // Each in the slot of its corner: an octant o ray starts in the corner it comes from, slot o.
    for (std::size_t slot = 0; slot < 8; ++slot) {
        CHECK(bvh.nodes[0].lo_x[slot] == ((slot & 1u) != 0 ? 9.0f : 0.0f));
        CHECK(bvh.nodes[0].lo_y[slot] == ((slot & 2u) != 0 ? 9.0f : 0.0f));
        CHECK(bvh.nodes[0].lo_z[slot] == ((slot & 4u) != 0 ? 9.0f : 0.0f));
    }
}

TEST_CASE("clustered sets cost less than with median splits", "[bvh]") {
    for (const bool mixed : {false, true}) {
        for (const std::size_t size : {100u, 1000u, 10000u}) {
            for (std::uint32_t seed = 0; seed < 5; ++seed) {
                CAPTURE(mixed, size, seed);
                const auto primitives = make_primitives(Spread::clustered, size, mixed, seed);
                CHECK(build_bvh(primitives).statistics.sah_cost < median_tree_cost(primitives));
            }
        }
    }
}

TEST_CASE("one large primitive is kept apart from many small ones", "[bvh]") {
    // A floor under a field of spheres. With the floor among the spheres half of the boxes on
    // the way to it are the floor's; apart, it is a leaf of the root.
    auto primitives = make_primitives(Spread::uniform, 1000, false, 4);
    for (BuildPrimitive& primitive : primitives) primitive.kind = SAHL_KIND_SPHERE;
    primitives.push_back({{{-100, -100, 0}, {100, 100, 0}}, SAHL_KIND_POLYGON, 1000});
    const Bvh bvh = build_bvh(primitives);
    CHECK(walk(bvh, primitives).fault == "");
    const device::BvhNode& root = bvh.nodes[0];
    const auto is_polygon = [](std::uint32_t child) {
        return child != 0xffffffffu && (child & SAHL_CHILD_LEAF) != 0 &&
               (child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK) == SAHL_KIND_POLYGON;
    };
    CHECK(std::count_if(root.child, root.child + 8, is_polygon) == 1);
    // Root and floor, and a thousandth for all the spheres together.
    CHECK(bvh.statistics.sah_cost < 3.01);
}
