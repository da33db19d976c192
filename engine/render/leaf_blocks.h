// The leaves of a BVH as the blocks that kernels intersect.
#pragma once

#include "engine/device/memory.h"
#include "engine/render/host_scene.h"
#include "engine/scene/scene.h"

namespace sahl {

/// One block a leaf, in leaf order, at the offsets that the tree's child references name.
HostMemory pack_leaf_blocks(MemoryAccountant& accountant, const Scene& scene, const HostScene& host);

}  // namespace sahl
