// The bounding volume hierarchy over all primitives: binned SAH with spatial splits, built in parallel,
// collapsed to 8-wide nodes at least cost, whose leaves are blocks of up to four primitives of one kind.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accel/bounds.h"
#include "engine/core/uninitialized_vector.h"
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
    std::uint64_t references = 0;  ///< in leaves; more than primitives where these were cut
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    int depth = 0;         ///< levels of 8-wide nodes
    double sah_cost = 0;   ///< expected cost of a random ray that hits the root box, see below
    double leaf_fill = 0;  ///< references per leaf, of 4
    double build_seconds = 0;
};

/// Where the corners of triangles are: nine floats each, those of primitive `id` from
/// data[primitives[id].data] on, which is how scenes are lowered.
struct TriangleCorners {
    const float* data = nullptr;
    const device::DevicePrimitive* primitives = nullptr;

    bool empty() const { return data == nullptr; }
    const float* of(std::uint32_t id) const { return data + primitives[id].data; }
};

/// What the time to build a tree is worth. Fast: triangles are cut beforehand, if at all, see pre_split.h.
enum class BuildQuality { fast, high };

/// A leaf of the wide tree: one block, or an instance. No defaulted members: arrays of them are not cleared.
struct BvhLeaf {
    std::uint32_t kind;
    std::uint32_t count;   ///< 1..4
    std::uint32_t ids[4];  ///< ascending; behind them 0
};

/// Nodes in depth-first order, [0] the root. Leaf children carry SAHL_CHILD_LEAF, the kind, and a
/// line offset, or an instance's number. Leaves are numbered as depth-first visits of the slots 0..7 meet
/// them; leaf k's block starts where the blocks of leaves 0..k-1 end (block_lines()).
struct Bvh {
    UninitializedVector<device::BvhNode> nodes;
    UninitializedVector<BvhLeaf> leaves;
    std::uint32_t leaf_lines = 0;  ///< size of the leaf buffer in lines of 64 bytes
    Bounds bounds{};               ///< of all primitives; zeros if there are none
    BvhStatistics statistics;
};

/// As many references as a tree over `primitives` primitives has, or more: triangles that are cut in space
/// have one for each part.
constexpr std::uint64_t most_references(std::uint64_t primitives) { return primitives + primitives / 4; }

/// As many nodes as the tree over `primitives` primitives has, or more.
/// A node has two children at least, and where an inner one has c children and its parent p, these would not
/// all find room in the parent: p - 1 + c >= 9. With n nodes of k children each and l leaves the sum of k - 1
/// is l - 1, and that of f(k) = 3 (k - 1) - 5 is 3 (l - 1) - 5 n. f(2) = -2 and f(8) = 16, f is never
/// negative between, and a node of two children has a parent of eight, which has at most eight such: the sum
/// is not negative, or -2 for the root. So n <= (3 l - 1) / 5, and a leaf has a reference of its own.
constexpr std::uint64_t most_nodes(std::uint64_t primitives) {
    return 3 * most_references(primitives) / 5 + 1;
}

/// Lines of 64 bytes of a block of `kind`; none for instances.
std::uint32_t block_lines(std::uint32_t kind);

/// Builds the tree. The same primitives give the same tree, bit for bit, whatever the number of
/// threads. No primitives: a root whose slots are all empty.
/// Bounds must be finite; a box may be flat or a point. Throws Error(scene) when the leaf buffer
/// would exceed 2^27 lines or there are more than SAHL_MAX_PRIMITIVES.
/// A leaf holds one instance or one polygon. With `corners`, of triangles that are in `primitives`, long
/// triangles are cut: several leaves have them then, a leaf has each once, and a leaf's box is that of the
/// parts it has.
/// Sources: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies" (binning);
/// Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"; Ylitie, Karras, Laine
/// 2017, sec. 3 (collapse to wide nodes, octant-ordered slots).
Bvh build_bvh(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners = {},
              BuildQuality quality = BuildQuality::high);

/// Appends the nodes and leaves of `tree` to `forest`, their references moved along; bounds and
/// statistics stay the forest's. Returns the index of the tree's root. Throws as build_bvh.
std::uint32_t append_tree(Bvh& forest, const Bvh& tree);

}  // namespace sahl
