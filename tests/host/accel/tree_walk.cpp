#include "tests/host/accel/tree_walk.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sahl::test {

namespace {

// Independent of the engine's: lines of a block and weight of a visit, by kind.
constexpr std::uint32_t lines_of[] = {3, 2, 4, 4, 1, 4, 4, 4, 0};
constexpr double weight_of[] = {1, 1, 1.5, 1.5, 2, 2, 1.5, 1.5, 6};
constexpr std::uint32_t instance = 8;

bool same(const Bounds& a, const Bounds& b) {
    return std::equal(a.lo, a.lo + 3, b.lo) && std::equal(a.hi, a.hi + 3, b.hi);
}

bool within(const Bounds& box, const Bounds& outer) {
    for (int k = 0; k < 3; ++k) {
        if (box.lo[k] < outer.lo[k] || box.hi[k] > outer.hi[k]) return false;
    }
    return true;
}

double area(const Bounds& box) {
    const double x = double{box.hi[0]} - double{box.lo[0]};
    const double y = double{box.hi[1]} - double{box.lo[1]};
    const double z = double{box.hi[2]} - double{box.lo[2]};
    return 2 * (x * y + y * z + z * x);
}

void grow(Bounds& box, const Bounds& other) {
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::fmin(box.lo[k], other.lo[k]);
        box.hi[k] = std::fmax(box.hi[k], other.hi[k]);
    }
}

struct Below {
    Bounds bounds{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    std::size_t stack_need = 0;
    double area_sum = 0;  // weighted
    double box_sum = 0;   // the same with every area 1
};

struct Walk {
    const Bvh& bvh;
    bool parts;  // whether leaves may hold parts of primitives
    std::vector<const BuildPrimitive*> by_id;
    std::vector<std::vector<Bounds>> seen;  // the boxes of leaves, by id
    std::size_t next_node = 0;
    std::size_t next_leaf = 0;
    std::uint32_t next_line = 0;
    TreeFacts facts;

    void fault(const std::string& text) {
        if (facts.fault.empty()) facts.fault = text;
    }
    Below leaf(std::uint32_t reference, const Bounds& box);
    Below node(std::uint32_t index, int level);
};

Below Walk::leaf(std::uint32_t reference, const Bounds& box) {
    Below below;
    const std::size_t k = next_leaf++;
    if (k >= bvh.leaves.size()) {
        fault("more leaf references than leaves");
        return below;
    }
    const BvhLeaf& block = bvh.leaves[k];
    const std::uint32_t kind = reference >> 27 & 15u;
    if (kind > instance || kind != block.kind) fault("leaf " + std::to_string(k) + ": wrong kind");
    const std::uint32_t offset = kind == instance ? block.ids[0] : next_line;
    if ((reference & 0x07ffffffu) != offset) fault("leaf " + std::to_string(k) + ": wrong offset");
    next_line += lines_of[std::min(kind, instance)];
    if (block.count < 1 || block.count > (kind == instance ? 1 : 4))
        fault("leaf " + std::to_string(k) + ": wrong count");
    for (std::uint32_t i = 0; i < std::min(block.count, 4u); ++i) {
        const std::uint32_t id = block.ids[i];
        if (i > 0 && block.ids[i - 1] >= id) fault("leaf " + std::to_string(k) + ": ids do not ascend");
        if (id >= by_id.size()) {
            fault("unknown id " + std::to_string(id));
            continue;
        }
        seen[id].push_back(box);
        if (by_id[id]->kind != kind) fault("primitive " + std::to_string(id) + " in a leaf of another kind");
        grow(below.bounds, by_id[id]->bounds);
    }
    if (parts) {
        if (!within(box, below.bounds))
            fault("leaf " + std::to_string(k) + ": a box that is larger than its parts");
        below.bounds = box;
    }
    below.area_sum = weight_of[std::min(kind, instance)] * area(below.bounds);
    below.box_sum = weight_of[std::min(kind, instance)];
    return below;
}

Below Walk::node(std::uint32_t index, int level) {
    Below below;
    if (index != next_node++ || index >= bvh.nodes.size()) {
        fault("node " + std::to_string(index) + " is not in depth-first order");
        return below;
    }
    facts.depth = std::max(facts.depth, level);
    const device::BvhNode& node = bvh.nodes[index];
    std::size_t children = 0;
    std::size_t deepest = 0;
    for (std::size_t s = 0; s < 8; ++s) {
        const Bounds box{{node.lo_x[s], node.lo_y[s], node.lo_z[s]},
                         {node.hi_x[s], node.hi_y[s], node.hi_z[s]}};
        if (node.child[s] == 0xffffffffu) {
            if (!same(box, Below{}.bounds)) fault("an empty slot whose box is not");
            continue;
        }
        ++children;
        const bool is_leaf = (node.child[s] & 0x80000000u) != 0;
        const Below child = is_leaf ? leaf(node.child[s], box) : this->node(node.child[s], level + 1);
        if (!same(box, child.bounds))
            fault("node " + std::to_string(index) + ": a box that is not what it holds");
        grow(below.bounds, child.bounds);
        below.area_sum += child.area_sum;
        below.box_sum += child.box_sum;
        deepest = std::max(deepest, child.stack_need);
    }
    // All children are pushed, then one is popped and followed while the others wait.
    below.stack_need = children == 0 ? 0 : std::max(children, children - 1 + deepest);
    below.area_sum += children == 0 ? 0 : area(below.bounds);
    below.box_sum += 1;
    return below;
}

// Whether a grid of points on the triangle is in the boxes, but for the points' own rounding.
bool cover(const std::vector<Bounds>& boxes, const float* corners) {
    constexpr int steps = 24;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
            double point[3];
            double slack[3];
            for (int k = 0; k < 3; ++k) {
                const double a{corners[k]}, b{corners[3 + k]}, c{corners[6 + k]};
                point[k] = a + (b - a) * i / steps + (c - a) * j / steps;
                slack[k] = 1e-15 * (std::abs(a) + std::abs(b) + std::abs(c));
            }
            const bool covered = std::any_of(boxes.begin(), boxes.end(), [&](const Bounds& box) {
                for (int k = 0; k < 3; ++k) {
                    if (point[k] < double{box.lo[k]} - slack[k] || point[k] > double{box.hi[k]} + slack[k]) {
                        return false;
                    }
                }
                return true;
            });
            if (!covered) return false;
        }
    }
    return true;
}

// What is to be found out about a primitive's leaves.
using CheckLeaves = std::function<bool(const BuildPrimitive&, const std::vector<Bounds>&)>;

TreeFacts walk(const Bvh& bvh, const std::vector<BuildPrimitive>& primitives, bool parts,
               const CheckLeaves& are_right) {
    Walk walk{bvh, parts, {}, {}, 0, 0, 0, {}};
    walk.by_id.resize(primitives.size());
    walk.seen.resize(primitives.size());
    for (const BuildPrimitive& primitive : primitives) walk.by_id[primitive.id] = &primitive;
    const Below root = walk.node(0, 1);
    for (std::size_t id = 0; id < primitives.size(); ++id) {
        if (!are_right(*walk.by_id[id], walk.seen[id])) {
            walk.fault("primitive " + std::to_string(id) + " is in " + std::to_string(walk.seen[id].size()) +
                       " leaves that do not hold it");
        }
    }
    if (walk.next_node != bvh.nodes.size()) walk.fault("nodes that nothing refers to");
    if (walk.next_leaf != bvh.leaves.size()) walk.fault("leaves that nothing refers to");
    if (walk.next_line != bvh.leaf_lines) walk.fault("leaf_lines is not the end of the last block");
    if (!primitives.empty() && !same(root.bounds, bvh.bounds)) walk.fault("bounds are not the root's");
    walk.facts.stack_need = std::max<std::size_t>(1, root.stack_need);
    const bool flat = primitives.empty() || area(root.bounds) == 0;
    walk.facts.sah_cost = flat ? root.box_sum : root.area_sum / area(root.bounds);
    return walk.facts;
}

}  // namespace

TreeFacts walk(const Bvh& bvh, const std::vector<BuildPrimitive>& primitives) {
    return walk(bvh, primitives, false,
                [](const BuildPrimitive&, const std::vector<Bounds>& boxes) { return boxes.size() == 1; });
}

TreeFacts walk_parts(const Bvh& bvh, const TriangleSet& set) {
    return walk(bvh, set.primitives, true, [&](const BuildPrimitive& p, const std::vector<Bounds>& boxes) {
        if (p.kind == SAHL_KIND_TRIANGLE) return cover(boxes, set.corners().of(p.id));
        return boxes.size() == 1 && within(p.bounds, boxes[0]);
    });
}

}  // namespace sahl::test
