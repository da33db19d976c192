#include "engine/accel/bvh.h"

#include <chrono>
#include <string>
#include <utility>

#include "engine/accel/binary_tree.h"
#include "engine/accel/wide_collapse.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

void check_size(const std::vector<BuildPrimitive>& primitives) {
    if (primitives.size() > SAHL_MAX_PRIMITIVES) {
        throw Error(ExitCode::scene, "the scene has " + std::to_string(primitives.size()) +
                                         " primitives; the limit is " + std::to_string(SAHL_MAX_PRIMITIVES) +
                                         ": render fewer");
    }
}

}  // namespace

Bvh build_bvh(std::vector<BuildPrimitive> primitives, const TriangleCorners& corners, BuildQuality quality) {
    const auto start = std::chrono::steady_clock::now();
    check_size(primitives);
    const std::size_t size = primitives.size();
    Bvh bvh = empty_bvh();
    if (size > 0) {
        BinaryTree tree = build_binary_tree(std::move(primitives), corners, quality);
        bvh = collapse(tree);
    }
    bvh.statistics.primitives = size;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    bvh.statistics.build_seconds = seconds.count();
    return bvh;
}

std::uint32_t append_tree(Bvh& forest, const Bvh& tree) {
    const std::size_t root = forest.nodes.size();
    const std::uint64_t lines = std::uint64_t{forest.leaf_lines} + tree.leaf_lines;
    if (root + tree.nodes.size() > SAHL_CHILD_LEAF || lines > SAHL_CHILD_OFFSET_MASK + 1U) {
        throw Error(ExitCode::scene,
                    "the scene's groups have more primitives together than one acceleration structure can "
                    "address: render fewer at a time");
    }
    for (device::BvhNode node : tree.nodes) {
        for (std::size_t slot = 0; slot < 8; ++slot) {
            std::uint32_t& child = node.child[slot];
            const bool leaf = (child & SAHL_CHILD_LEAF) != 0;
            const bool empty = node.lo_x[slot] > node.hi_x[slot];
            const std::uint32_t kind = child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK;
            if (empty || (leaf && kind == SAHL_KIND_INSTANCE)) continue;
            child += leaf ? forest.leaf_lines : static_cast<std::uint32_t>(root);
        }
        forest.nodes.push_back(node);
    }
    forest.leaves.insert(forest.leaves.end(), tree.leaves.begin(), tree.leaves.end());
    forest.leaf_lines = static_cast<std::uint32_t>(lines);
    return static_cast<std::uint32_t>(root);
}

}  // namespace sahl
