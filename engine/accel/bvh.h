// The bounding volume hierarchy over all primitives: binned SAH, built in parallel, collapsed to
// 8-wide nodes whose leaves are blocks of up to four primitives of one kind.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accel/bounds.h"
#include "kernels/device_types.h"

namespace sahl {

/// What the builder knows of a primitive. Bounds must contain it, rounding included.
struct BuildPrimitive {
    Bounds bounds{};
    std::uint32_t kind = 0;  ///< SAHL_KIND_*
    std::uint32_t id = 0;    ///< index in Scene::primitives; of an instance: its number
};

/// `sah_cost` is the sum over nodes of area / root area, plus the same over leaves times 1 (triangles,
/// spheres), 1.5 (ellipsoids, cones, discs, boxes), 2 (polygons, solid cones) or 6 (instances), see
/// cost_model.h. In a tree whose root box is
/// a line or a point every box counts as visited.
struct BvhStatistics {
    std::uint64_t primitives = 0;
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    int depth = 0;         ///< levels of 8-wide nodes
    double sah_cost = 0;   ///< expected cost of a random ray that hits the root box, see below
    double leaf_fill = 0;  ///< primitives per leaf, of 4
    double build_seconds = 0;
};

/// A leaf of the wide tree: one block, or an instance.
struct BvhLeaf {
    std::uint32_t kind = 0;
    std::uint32_t count = 0;    ///< 1..4
    std::uint32_t ids[4] = {};  ///< ascending
};

/// Nodes in depth-first order, [0] the root. Leaf children carry SAHL_CHILD_LEAF, the kind, and a
/// line offset, or an instance's number. Leaves are numbered as depth-first visits of the slots 0..7 meet
/// them; leaf k's block starts where the blocks of leaves 0..k-1 end (block_lines()).
struct Bvh {
    std::vector<device::BvhNode> nodes;
    std::vector<BvhLeaf> leaves;
    std::uint32_t leaf_lines = 0;  ///< size of the leaf buffer in lines of 64 bytes
    Bounds bounds{};               ///< of all primitives; zeros if there are none
    BvhStatistics statistics;
};

/// As many nodes as the tree over `primitives` primitives has, or more.
/// A node with fewer than eight children has leaves alone, at least two. With b of those, i others and
/// l leaves below these: 8 i + 1 = i + b + l and 2 b + l <= primitives, so that i + b is largest
/// where l = 0, which is 4/7 of the primitives.
constexpr std::uint64_t most_nodes(std::uint64_t primitives) { return 4 * primitives / 7 + 1; }

/// Lines of 64 bytes of a block of `kind`; none for instances.
std::uint32_t block_lines(std::uint32_t kind);

/// Builds the tree. The same primitives give the same tree, bit for bit, whatever the number of
/// threads. No primitives: a root whose slots are all empty.
/// Bounds must be finite; a box may be flat or a point. Throws Error(scene) when the leaf buffer
/// would exceed 2^28 lines or there are more than SAHL_MAX_PRIMITIVES.
/// A leaf holds one instance.
/// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies" (binning);
/// Ylitie, Karras, Laine 2017, sec. 3 (octant-ordered slots).
Bvh build_bvh(std::vector<BuildPrimitive> primitives);

/// Appends the nodes and leaves of `tree` to `forest`, their references moved along; bounds and
/// statistics stay the forest's. Returns the index of the tree's root. Throws as build_bvh.
std::uint32_t append_tree(Bvh& forest, const Bvh& tree);

}  // namespace sahl
