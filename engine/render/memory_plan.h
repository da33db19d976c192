// What a render holds in memory, known before it begins: the contract behind --max-mem.
#pragma once

#include <cstdint>
#include <span>

#include "engine/accel/bvh.h"
#include "engine/device/device.h"
#include "engine/film/aov.h"
#include "engine/render/render_settings.h"
#include "engine/render/scene_memory.h"
#include "engine/scene/scene.h"

namespace sahl {

/// What of a job decides how much memory it takes.
struct MemoryRequest {
    std::uint64_t pixels = 0;   ///< of the image, or of its crop
    std::uint64_t samples = 0;  ///< of all pixels
    int depth = 0;              ///< the largest, of several images
    std::uint32_t light_count = 0;
    std::uint32_t ray_budget = 0;  ///< the most rays of a batch
    std::uint64_t aovs = 0;        ///< bytes of the AOV images, see with_aovs()
    bool counts_costs = false;     ///< an AOV is of what pixels cost
    std::uint64_t encoder = 0;     ///< bytes of encoding the largest file, see encoder_bytes()
    bool writes_behind = false;    ///< an image is written while the next one is traced
};

/// What `settings` ask of `device` for a scene of `light_count` lights, without AOVs and files.
MemoryRequest memory_request(const Device& device, const RenderSettings& settings, std::uint32_t light_count);

/// The request with `aovs` as well.
MemoryRequest with_aovs(MemoryRequest request, std::span<const Aov> aovs);

/// Bytes by what they are for, and how many rays a batch may have with them.
struct MemoryPlan {
    SceneMemory scene;
    std::uint64_t aovs = 0;
    std::uint64_t aov_queues = 0;  ///< while AOVs are traced
    std::uint64_t ray_queues = 0;
    std::uint64_t film = 0;
    std::uint64_t image = 0;  ///< the resolved film
    std::uint64_t encoder = 0;
    std::uint32_t ray_budget = 0;
    bool writes_behind = false;

    /// The most that is held at one time.
    std::uint64_t total() const;
};

/// Fewest rays of a batch: what a work-item of a CPU traces.
inline constexpr std::uint32_t least_ray_budget = 64;

/// The OpenCL driver with its compiler, the image library and the program itself: what a process has
/// beside the plan. Measured with PoCL 3.1, all kernels compiled anew, 2 and 4 threads: 366 MB.
inline constexpr std::uint64_t runtime_base_bytes = std::uint64_t{384} << 20U;

/// The plan with the largest batches that keep total() within `limit`, at most those of the request.
/// Throws Error(memory) naming the least limit that would do.
MemoryPlan plan_memory(const SceneMemory& scene, const MemoryRequest& request, std::uint64_t limit);

/// Throws Error(memory), naming a limit that is enough, when `limit` leaves no room to build the scene's
/// trees; the bound if it does. Errors as bound_scene_memory.
SceneMemory check_room_to_build(const Scene& scene, const MemoryRequest& request, std::uint64_t limit);

/// The plan of a render that makes the scene ready, as far as it is known without a device having it.
/// Errors as check_room_to_build, plan_memory and make_host_scene.
MemoryPlan plan_render(const Scene& scene, const MemoryRequest& request, std::uint64_t limit,
                       BuildQuality quality = BuildQuality::high);

}  // namespace sahl
