#include "engine/render/launches.h"

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/render/incoherent_intersect.h"
#include "kernels/rays_per_item.h"

namespace sahl {
namespace {

constexpr const char* counting_option = "-DSAHL_COUNT_VISITS";

Launch per_ray(std::uint32_t rays_per_item, std::uint32_t generation, std::uint32_t count) {
    return {(count + rays_per_item - 1) / rays_per_item, generation, count, rays_per_item};
}

Launch per_block(const WaitingBatch& in_work) {
    return {compact_blocks(in_work.count), in_work.generation, in_work.count, SAHL_COMPACT_BLOCK};
}

/// The launch of a kernel that traces rays so many to each work-item.
Launch per_traced_ray(Traversal way, const WaitingBatch& in_work, std::uint32_t rays,
                      std::uint32_t rays_of_packets, std::uint32_t rays_of_streams) {
    if (way == Traversal::packet) rays = rays_of_packets;
    if (way == Traversal::stream) rays = rays_of_streams;
    return per_ray(rays, in_work.generation, in_work.count);
}

/// A file of kernels/, and the kernel in it, that traces rays that way.
std::string traversing(const char* kernel, Traversal traversal) {
    return fmt::format("{}_{}", kernel, name_of(traversal));
}

/// Launches a kernel; counting ones add up what they do, by ray or by work-item.
/// `sums_of`: what they are added to, of a generation.
template <class SumsOf, class... Arguments>
void launch_counted(Wavefront& wavefront, Kernel& kernel, const Launch& launch, bool by_ray,
                    const SumsOf& sums_of, const Arguments&... arguments) {
    if (wavefront.visits == nullptr) {
        kernel.launch(launch, arguments...);
        return;
    }
    kernel.launch(launch, arguments..., wavefront.visits->next());
    GenerationVisits& generation = wavefront.visits->generations[launch.generation];
    KernelVisits& sums = sums_of(generation);
    wavefront.visits->add_to(sums, by_ray ? launch.items : launch.work_items, generation.lit);
}

/// Adds what the last launch counted to its rays' pixels. `rays`: that were traced for each of the batch.
void add_to_pixels(Wavefront& wavefront, const WaitingBatch& in_work, std::span<const std::uint32_t> rays) {
    Buffer& ids = wavefront.queues.batches[in_work.slot].ids;
    const auto pixel_of = ids.map<std::uint32_t>(MapMode::read, in_work.count);
    wavefront.visits->add_to_pixels({pixel_of.data(), in_work.count}, rays);
}

/// The shadow rays of each hit.
std::vector<std::uint32_t> shadow_rays_of(RayQueues& queues, std::uint32_t count) {
    const auto outcomes = queues.outcomes.map<std::uint32_t>(MapMode::read, count);
    std::vector<std::uint32_t> rays(outcomes.begin(), outcomes.end());
    for (std::uint32_t& outcome : rays) outcome /= SAHL_OUTCOME_SHADOW_RAY;
    return rays;
}

std::uint64_t count_hits(RayQueues& queues, std::uint32_t count) {
    const auto primitives = queues.hit_ids.map<std::uint32_t>(MapMode::read, count);
    return static_cast<std::uint64_t>(
        std::count_if(primitives.begin(), primitives.end(),
                      [](std::uint32_t primitive) { return primitive != SAHL_NO_PRIMITIVE; }));
}

}  // namespace

std::uint32_t rays_in_groups(const Device& device) { return std::max(device.rays_per_item(), SAHL_LANES); }

std::vector<std::string> wavefront_sources(Traversal traversal) {
    return {"generate.cl", traversing("intersect", traversal) + ".cl", "shade.cl",
            traversing("shadow", traversal) + ".cl", "compact.cl"};
}

Program build_wavefront_program(Device& device, Compilation compilation) {
    // About half of the work, and what is needed last.
    const std::set<std::string> beside{traversing("shadow", device.traversal()), "count_children",
                                       "sum_children", "compact"};
    return {device, wavefront_sources(device.traversal()), "", compilation, beside};
}

Program build_counting_program(Device& device, Traversal traversal, Compilation compilation) {
    return {device, wavefront_sources(traversal), counting_option, compilation};
}

std::vector<std::string> incoherent_sources(Traversal traversal) {
    return {traversing("intersect", traversal) + ".cl"};
}

Program build_incoherent_program(Device& device, bool counting) {
    return {device, incoherent_sources(device.incoherent_traversal()), counting ? counting_option : ""};
}

TracingKernel tracing_kernel(const char* name, Traversal way, Program& program) {
    return {way, program.kernel(traversing(name, way))};
}

WavefrontKernels::WavefrontKernels(Traversal traversal, Program& program)
    : WavefrontKernels(traversal, program, tracing_kernel("intersect", traversal, program)) {}

WavefrontKernels::WavefrontKernels(Traversal traversal, Program& program, TracingKernel intersecting)
    : generate(program.kernel("generate")),
      shade(program.kernel("shade")),
      intersect(std::move(intersecting)),
      shadow(tracing_kernel("shadow", traversal, program)),
      count_children(program.kernel("count_children")),
      sum_children(program.kernel("sum_children")),
      compact(program.kernel("compact")) {}

void launch_generate(Wavefront& wavefront, const device::CameraConstants& camera,
                     const device::WaveConstants& wave, RayBatch& out) {
    wavefront.kernels.generate.launch(per_ray(rays_in_groups(wavefront.device), 0, wave.count), camera, wave,
                                      out.rays, out.ids, wavefront.queues.capacity);
}

void launch_intersect(Wavefront& wavefront, const WaitingBatch& in_work) {
    const DeviceScene& scene = wavefront.scene;
    RayQueues& q = wavefront.queues;
    const RayBatch& batch = q.batches[in_work.slot];
    TracingKernel& intersect = in_work.coherent || wavefront.incoherent == nullptr
                                   ? wavefront.kernels.intersect
                                   : wavefront.incoherent->kernel_for(in_work.count);
    const auto sums_of = [&](GenerationVisits& generation) -> IntersectVisits& {
        return generation.intersect[name_of(intersect.way)];
    };
    launch_counted(
        wavefront, intersect.kernel,
        per_traced_ray(intersect.way, in_work, wavefront.device.rays_per_item(), SAHL_PACKET_RAYS,
                       SAHL_STREAM_RAYS),
        intersect.way == Traversal::scalar,
        [&](GenerationVisits& generation) -> KernelVisits& { return sums_of(generation).visits; },
        scene.nodes, scene.leaves, scene.outlines, scene.instances, scene.constants, batch.rays, batch.ids,
        q.hits, q.hit_ids, q.capacity, in_work.count);
    if (wavefront.visits != nullptr) {
        IntersectVisits& sums = sums_of(wavefront.visits->generations[in_work.generation]);
        sums.rays += in_work.count;
        sums.hits += count_hits(q, in_work.count);
        add_to_pixels(wavefront, in_work, std::vector<std::uint32_t>(in_work.count, 1));
    }
}

void launch_shade(Wavefront& wavefront, const WaitingBatch& in_work, bool spawn, Contributions& out) {
    const DeviceScene& scene = wavefront.scene;
    RayQueues& q = wavefront.queues;
    const RayBatch& batch = q.batches[in_work.slot];
    launch_counted(
        wavefront, wavefront.kernels.shade,
        per_ray(rays_in_groups(wavefront.device), in_work.generation, in_work.count), false,
        [](GenerationVisits& generation) -> KernelVisits& { return generation.shade; }, scene.primitives,
        scene.shape_data, scene.instances, scene.materials, scene.textures, scene.lights, scene.constants,
        batch.rays, batch.ids, q.hits, q.hit_ids, out.light, out.pixels, q.shadow_surfaces, q.shadow_light,
        q.children, q.child_ids, q.outcomes, q.capacity, in_work.count, spawn ? 1U : 0U);
}

void launch_shadow(Wavefront& wavefront, const WaitingBatch& in_work, Contributions& out) {
    const DeviceScene& scene = wavefront.scene;
    RayQueues& q = wavefront.queues;
    TracingKernel& shadow = wavefront.kernels.shadow;
    launch_counted(
        wavefront, shadow.kernel,
        per_traced_ray(shadow.way, in_work, rays_in_groups(wavefront.device), SAHL_SHADOW_RAYS,
                       SAHL_SHADOW_RAYS),
        shadow.way == Traversal::scalar,
        [](GenerationVisits& generation) -> KernelVisits& { return generation.shadow; }, scene.nodes,
        scene.leaves, scene.outlines, scene.instances, scene.primitives, scene.materials, scene.lights,
        scene.constants, q.hit_ids, q.shadow_surfaces, q.shadow_light, q.outcomes, out.light, q.capacity,
        in_work.count);
    if (wavefront.visits != nullptr) {
        add_to_pixels(wavefront, in_work, shadow_rays_of(q, in_work.count));
    }
}

void launch_count_children(Wavefront& wavefront, const WaitingBatch& in_work) {
    RayQueues& q = wavefront.queues;
    wavefront.kernels.count_children.launch(per_block(in_work), q.outcomes, q.block_counts,
                                            q.block_shadow_rays, in_work.count,
                                            compact_blocks(in_work.count));
}

void launch_sum_children(Wavefront& wavefront, const WaitingBatch& in_work, Contributions& out) {
    RayQueues& q = wavefront.queues;
    const std::uint32_t blocks = compact_blocks(in_work.count);
    wavefront.kernels.sum_children.launch({1, in_work.generation, blocks, blocks}, q.block_counts,
                                          q.block_shadow_rays, out.totals, blocks);
}

void launch_compact(Wavefront& wavefront, const WaitingBatch& in_work, RayBatch& next, RayBatch& waiting,
                    Contributions& out) {
    RayQueues& q = wavefront.queues;
    wavefront.kernels.compact.launch(per_block(in_work), q.children, q.child_ids, q.outcomes, q.block_counts,
                                     next.rays, next.ids, waiting.rays, waiting.ids, out.totals, q.capacity,
                                     in_work.count, compact_blocks(in_work.count));
}

}  // namespace sahl
