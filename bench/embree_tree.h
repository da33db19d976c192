// The tree that Embree's builder makes, valued as Sahl values its own.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

#include "engine/render/lower_scene.h"

namespace sahl::bench {

struct EmbreeTree {
    double sah_cost = 0;  ///< as BvhStatistics
    std::uint64_t references = 0;
    double seconds = 0;  ///< in rtcBuildBVH
};

/// Builds a binary tree of the triangles by rtcBuildBVH at high quality, with spatial splits, a third more
/// references at most and leaves of four; and collapses it to 8-wide nodes at least cost.
EmbreeTree build_embree_tree(RTCDevice device, const LoweredScene& lowered);

}  // namespace sahl::bench
