// The device memory of a wave: ray batches, and what one generation leaves for the next kernel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/device.h"

namespace sahl {

/// Rays of one generation (arrays of device_types.h, SAHL_RAY_*).
struct RayBatch {
    Buffer rays;
    Buffer ids;
};

/// What a generation leaves for the host.
struct Contributions {
    Buffer light;   ///< to add to the film: three float arrays
    Buffer pixels;  ///< that it goes to
    Buffer totals;  ///< SAHL_TOTAL_*
};

/// Waves whose ray trees are traced in turn, so that the device has work of one while the host looks at what
/// has become of another.
constexpr std::uint32_t waves_in_flight = 2;

/// RayQueues::capacity for batches of `rays` rays: whole cache lines, and no multiple of 4 KB, at which
/// the arrays of a batch would compete for the same sets of the cache.
std::uint32_t ray_capacity(std::uint32_t rays);

/// What RayQueues of these arguments allocate.
std::size_t ray_queue_bytes(std::uint32_t rays, int depth, std::uint32_t light_count);

/// The most rays of a batch that `device` can launch and hold, no buffer being larger than it gives.
std::uint32_t most_rays(const Device& device, std::uint32_t light_count);

struct RayQueues {
    /// All buffers for batches of ray_capacity(rays) rays.
    RayQueues(Device& device, std::uint32_t rays, int depth, std::uint32_t light_count);

    std::uint32_t capacity;
    /// Of each wave in flight the batch in work and those that wait: a generation leaves at most one waiting,
    /// so depth + 1 a wave, one wave's after the other's.
    std::vector<RayBatch> batches;
    Buffer hits;
    Buffer hit_ids;
    Buffer shadow_surfaces;
    Buffer shadow_light;  ///< three arrays a light
    Buffer children;      ///< two batches' arrays: reflected, transmitted
    Buffer child_ids;
    Buffer outcomes;
    Buffer block_counts;
    Buffer block_shadow_rays;
    /// Two a wave in flight, so that the host adds one to the film while the device fills the other.
    Contributions contributions[2 * waves_in_flight];
};

}  // namespace sahl
