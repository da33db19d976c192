#include "engine/render/ray_queues.h"

#include <cstddef>
#include <string>

#include "kernels/device_types.h"

namespace sahl {
namespace {

constexpr std::size_t word = 4;

}  // namespace

RayQueues::RayQueues(Device& device, std::uint32_t ray_capacity, int depth, std::uint32_t light_count)
    : capacity((ray_capacity + 15U) / 16U * 16U) {
    const std::size_t array = capacity * word;
    const std::size_t blocks = (capacity + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK;
    for (int i = 0; i <= depth; ++i) {
        const std::string name = "ray batch " + std::to_string(i);
        batches.push_back({Buffer(device, SAHL_RAY_FLOATS * array, name),
                           Buffer(device, SAHL_RAY_UINTS * array, name + " ids")});
    }
    hits = Buffer(device, SAHL_HIT_FLOATS * array, "hits");
    hit_primitives = Buffer(device, array, "hit primitives");
    shadow_surfaces = Buffer(device, SAHL_SURFACE_FLOATS * array, "shadow surfaces");
    shadow_light = Buffer(device, 3 * light_count * array, "shadow light");
    children = Buffer(device, 2 * SAHL_RAY_FLOATS * array, "children");
    child_ids = Buffer(device, 2 * SAHL_RAY_UINTS * array, "child ids");
    outcomes = Buffer(device, array, "outcomes");
    block_counts = Buffer(device, 2 * blocks * word, "block counts");
    block_shadow_rays = Buffer(device, blocks * word, "block shadow rays");
    totals = Buffer(device, 3 * word, "totals");
    for (Contributions& c : contributions) {
        c.light = Buffer(device, 3 * array, "contributions");
        c.pixels = Buffer(device, array, "contribution pixels");
    }
}

}  // namespace sahl
