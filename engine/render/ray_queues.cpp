#include "engine/render/ray_queues.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "kernels/device_types.h"

namespace sahl {
namespace {

constexpr std::size_t word = 4;

/// Bytes of each buffer.
struct Sizes {
    Sizes(std::uint32_t capacity, std::uint32_t light_count)
        : array(std::size_t{capacity} * word),
          blocks((capacity + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK),
          shadow_light(3 * light_count * array) {}

    std::size_t array;   ///< of a word a ray
    std::size_t blocks;  ///< of compaction, a number
    std::size_t rays = SAHL_RAY_FLOATS * array;
    std::size_t ids = SAHL_RAY_UINTS * array;
    std::size_t hits = SAHL_HIT_FLOATS * array;
    std::size_t hit_ids = SAHL_HIT_UINTS * array;
    std::size_t shadow_surfaces = SAHL_SURFACE_FLOATS * array;
    std::size_t shadow_light;
    std::size_t outcomes = array;
    std::size_t block_counts = 2 * blocks * word;
    std::size_t block_shadow_rays = blocks * word;
    std::size_t totals = SAHL_TOTALS * word;
    std::size_t light = 3 * array;
    std::size_t pixels = array;

    std::size_t largest() const { return std::max(2 * rays, shadow_light); }
};

}  // namespace

std::uint32_t ray_capacity(std::uint32_t rays) {
    constexpr std::uint32_t line = 16;
    constexpr std::uint32_t page = 1024;
    const std::uint32_t length = std::max((rays + line - 1) / line, 1U) * line;
    return length % page == 0 ? length - line : length;
}

std::size_t ray_queue_bytes(std::uint32_t rays, int depth, std::uint32_t light_count) {
    const Sizes size(ray_capacity(rays), light_count);
    const auto batches = waves_in_flight * (static_cast<std::size_t>(depth) + 1);
    const auto footprint = Buffer::footprint;
    return batches * (footprint(size.rays) + footprint(size.ids)) + footprint(2 * size.rays) +
           footprint(2 * size.ids) + footprint(size.hits) + footprint(size.hit_ids) +
           footprint(size.shadow_surfaces) + footprint(size.shadow_light) + footprint(size.outcomes) +
           footprint(size.block_counts) + footprint(size.block_shadow_rays) +
           2 * waves_in_flight * (footprint(size.light) + footprint(size.pixels) + footprint(size.totals));
}

std::uint32_t most_rays(const Device& device, std::uint32_t light_count) {
    const std::uint64_t launchable = std::uint64_t{device.max_work_items()} * device.rays_per_item();
    auto rays = static_cast<std::uint32_t>(std::min(launchable, std::uint64_t{1} << 30U));
    while (rays > 1 && Sizes(ray_capacity(rays), light_count).largest() > device.info().max_allocation)
        rays /= 2;
    return rays;
}

RayQueues::RayQueues(Device& device, std::uint32_t rays, int depth, std::uint32_t light_count)
    : capacity(ray_capacity(rays)) {
    const Sizes size(capacity, light_count);
    for (std::size_t i = 0; i < waves_in_flight * (static_cast<std::size_t>(depth) + 1); ++i) {
        const std::string name = "ray batch " + std::to_string(i);
        batches.push_back({Buffer(device, size.rays, name), Buffer(device, size.ids, name + " ids")});
    }
    hits = Buffer(device, size.hits, "hits");
    hit_ids = Buffer(device, size.hit_ids, "hit ids");
    shadow_surfaces = Buffer(device, size.shadow_surfaces, "shadow surfaces");
    shadow_light = Buffer(device, size.shadow_light, "shadow light");
    children = Buffer(device, 2 * size.rays, "children");
    child_ids = Buffer(device, 2 * size.ids, "child ids");
    outcomes = Buffer(device, size.outcomes, "outcomes");
    block_counts = Buffer(device, size.block_counts, "block counts");
    block_shadow_rays = Buffer(device, size.block_shadow_rays, "block shadow rays");
    for (Contributions& c : contributions) {
        c.light = Buffer(device, size.light, "contributions");
        c.pixels = Buffer(device, size.pixels, "contribution pixels");
        c.totals = Buffer(device, size.totals, "totals");
    }
}

}  // namespace sahl
