#include "engine/render/memory_plan.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/device/buffer.h"
#include "engine/render/host_scene.h"
#include "engine/render/ray_queues.h"
#include "engine/render/trace_aovs.h"
#include "engine/render/visit_counter.h"

namespace sahl {
namespace {

std::string human(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

/// The plan for batches of `rays` rays.
MemoryPlan plan_for(const SceneMemory& scene, const MemoryRequest& request, std::uint32_t rays) {
    const auto batch = static_cast<std::uint32_t>(std::min<std::uint64_t>(rays, request.samples));
    const auto aov_batch = static_cast<std::uint32_t>(std::min<std::uint64_t>(rays, request.pixels));
    MemoryPlan plan;
    plan.scene = scene;
    plan.ray_budget = rays;
    plan.ray_queues = ray_queue_bytes(batch, request.depth, request.light_count);
    plan.film = HostMemory::mapped_bytes(request.pixels * film_pixel_bytes);
    if (request.aovs > 0) plan.aov_queues = aov_queue_bytes(aov_batch);
    if (request.counts_costs) {
        const std::uint64_t counts = visit_counter_bytes(ray_capacity(batch));
        plan.aov_queues = std::max(plan.aov_queues, plan.ray_queues + plan.film + counts);
    }
    plan.image = request.pixels * 3 * sizeof(float);
    plan.aovs = request.aovs;
    plan.encoder = request.encoder;
    plan.writes_behind = request.writes_behind;
    return plan;
}

}  // namespace

MemoryRequest memory_request(const Device& device, const RenderSettings& settings,
                             std::uint32_t light_count) {
    const Crop crop =
        settings.crop.value_or(Crop{0, 0, settings.resolution.width, settings.resolution.height});
    MemoryRequest request;
    request.pixels =
        static_cast<std::uint64_t>(crop.x1 - crop.x0) * static_cast<std::uint64_t>(crop.y1 - crop.y0);
    const int samples = settings.samples ? settings.samples->count() : settings.spp;
    request.samples = request.pixels * static_cast<std::uint64_t>(samples);
    request.depth = settings.depth;
    request.light_count = light_count;
    request.ray_budget = std::min(settings.ray_budget, most_rays(device, light_count));
    return request;
}

MemoryRequest with_aovs(MemoryRequest request, std::span<const Aov> aovs) {
    for (const Aov aov : aovs) request.aovs += aov_pixel_bytes(aov) * request.pixels;
    request.counts_costs = std::any_of(aovs.begin(), aovs.end(), is_cost);
    return request;
}

std::uint64_t MemoryPlan::total() const {
    const std::uint64_t writing = image + encoder;
    // Of the image that is written while others are traced, or made ready.
    const std::uint64_t behind = writes_behind ? aovs + writing : 0;
    // A file is encoded while its image is traced, where its format allows it, or behind.
    const std::uint64_t tracing =
        writes_behind ? std::max(ray_queues, writing) : std::max(ray_queues, image) + encoder;
    return behind + std::max({scene.loaded + scene.building,             // making the scene ready
                              scene.device() + aovs + aov_queues,        // tracing AOVs
                              scene.device() + aovs + film + tracing});  // tracing, writing files
}

MemoryPlan plan_memory(const SceneMemory& scene, const MemoryRequest& request, std::uint64_t limit) {
    std::uint32_t rays = request.ray_budget;
    MemoryPlan plan = plan_for(scene, request, rays);
    while (plan.total() > limit && rays > least_ray_budget) {
        rays = std::max(rays / 2, least_ray_budget);
        plan = plan_for(scene, request, rays);
    }
    if (plan.total() <= limit) return plan;
    throw Error(
        ExitCode::memory,
        fmt::format("the render needs at least {} bytes of memory ({}), where {} ({}) may be used; raise "
                    "--max-mem to that, or take a smaller image, scene or depth",
                    plan.total(), human(plan.total()), limit, human(limit)));
}

SceneMemory check_room_to_build(const Scene& scene, const MemoryRequest& request, std::uint64_t limit) {
    const SceneMemory bound = bound_scene_memory(scene);
    if (bound.loaded + bound.building > limit) plan_memory(bound, request, limit);
    return bound;
}

MemoryPlan plan_render(const Scene& scene, const MemoryRequest& request, std::uint64_t limit,
                       BuildQuality quality) {
    const SceneMemory bound = check_room_to_build(scene, request, limit);
    return plan_memory(measure_scene_memory(scene, make_host_scene(scene, quality), bound), request, limit);
}

}  // namespace sahl
