#include "engine/render/ray_queues.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "kernels/device_types.h"

namespace sahl {
namespace {

constexpr std::size_t word = 4;

std::uint32_t array_length(std::uint32_t rays) {
    constexpr std::uint32_t line = 16;
    constexpr std::uint32_t page = 1024;
    const std::uint32_t length = std::max((rays + line - 1) / line, 1U) * line;
    return length % page == 0 ? length - line : length;
}

}  // namespace

RayQueues::RayQueues(Device& device, std::uint32_t ray_capacity, int depth, std::uint32_t light_count)
    : capacity(array_length(ray_capacity)) {
    const std::size_t array = capacity * word;
    const std::size_t blocks = (capacity + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK;
    for (int i = 0; i <= depth; ++i) {
        const std::string name = "ray batch " + std::to_string(i);
        batches.push_back({Buffer(device, SAHL_RAY_FLOATS * array, name),
                           Buffer(device, SAHL_RAY_UINTS * array, name + " ids")});
    }
    hits = Buffer(device, SAHL_HIT_FLOATS * array, "hits");
    hit_ids = Buffer(device, SAHL_HIT_UINTS * array, "hit ids");
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
