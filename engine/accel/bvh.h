// The bounding volume hierarchy over all primitives: binned SAH, built in parallel, collapsed to
// 8-wide nodes whose leaves are blocks of up to four primitives of one kind.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/device_types.h"

namespace sahl {

struct Bounds {
    float lo[3];
    float hi[3];
};

/// What the builder knows of a primitive. Bounds must contain it, rounding included.
struct BuildPrimitive {
    Bounds bounds;
    std::uint32_t kind = 0;  ///< SAHL_KIND_*
    std::uint32_t id = 0;    ///< index in Scene::primitives
};

struct BvhStatistics {
    std::uint64_t primitives = 0;
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    int depth = 0;            ///< levels of 8-wide nodes
    double sah_cost = 0;      ///< expected node plus block visits of a random ray that hits the root box
    double leaf_fill = 0;     ///< primitives per leaf, of 4
    double build_seconds = 0;
};

/// A leaf of the wide tree: one block.
struct BvhLeaf {
    std::uint32_t kind = 0;
    std::uint32_t count = 0;     ///< 1..4
    std::uint32_t ids[4] = {};   ///< ascending
};

/// Nodes in depth-first order, [0] the root. Leaf children carry SAHL_CHILD_LEAF, the kind, and a
/// line offset: leaf k's block starts where the blocks of leaves 0..k-1 end (block_lines()).
struct Bvh {
    std::vector<device::BvhNode> nodes;
    std::vector<BvhLeaf> leaves;
    std::uint32_t leaf_lines = 0;  ///< size of the leaf buffer in lines of 64 bytes
    Bounds bounds{};
    BvhStatistics statistics;
};

/// Lines of 64 bytes of a block of `kind`.
std::uint32_t block_lines(std::uint32_t kind);

/// Builds the tree. The same primitives give the same tree, bit for bit, whatever the number of
/// threads. No primitives: a root whose slots are all empty.
/// Throws Error(scene) when the leaf buffer would exceed 2^28 lines.
/// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies" (binning);
/// Ylitie, Karras, Laine 2017, sec. 3 (octant-ordered slots).
Bvh build_bvh(std::vector<BuildPrimitive> primitives);

}  // namespace sahl
