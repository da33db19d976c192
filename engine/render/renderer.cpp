#include "engine/render/renderer.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/host_steps.h"
#include "engine/core/log.h"
#include "engine/render/camera_constants.h"
#include "engine/render/explain.h"
#include "engine/render/incoherent_intersect.h"
#include "engine/render/trace_aovs.h"
#include "engine/render/wavefront.h"
#include "engine/self_test/first_use.h"

namespace sahl {
namespace {

constexpr std::uint64_t least_explained_batch = 1024;  // rays

/// Quick kernels trace them in a fifth of a second; to compile optimized ones takes seconds longer.
constexpr std::uint64_t most_rays_of_quick_kernels = 1U << 18U;

/// The pixels that `settings` ask for.
Crop crop_of(const RenderSettings& settings) {
    const Resolution& resolution = settings.resolution;
    const Crop crop = settings.crop.value_or(Crop{0, 0, resolution.width, resolution.height});
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > resolution.width || crop.y1 > resolution.height) {
        throw Error(ExitCode::usage, "the crop must lie inside the image");
    }
    return crop;
}

SampleRange samples_of(const RenderSettings& settings) {
    const SampleRange samples = settings.samples.value_or(SampleRange{0, settings.spp});
    if (samples.begin < 0 || samples.begin >= samples.end || samples.end > settings.spp) {
        throw Error(ExitCode::usage, "the range of samples must lie within the samples a pixel");
    }
    return samples;
}

std::uint64_t pixel_count(const Crop& crop) {
    return std::uint64_t(crop.x1 - crop.x0) * std::uint64_t(crop.y1 - crop.y0);
}

}  // namespace

Compilation compilation_for(const MemoryRequest& job, std::size_t images) {
    // A ray and its shadow rays a generation: of most scenes fewer, of glass in glass more.
    const std::uint64_t rays =
        job.samples * images * (1U + job.light_count) * static_cast<unsigned>(1 + job.depth);
    return rays <= most_rays_of_quick_kernels ? Compilation::quick : Compilation::optimized;
}

struct Renderer::Impl {
    Impl(Device& on, const Scene& scene, const MemoryRequest& job, BuildQuality quality, Compilation how)
        : device(on),
          compilation(how),
          cameras(scene.cameras),
          program(build_wavefront_program(on, how)),
          kernels(on.traversal(), program),
          incoherent(on, program, kernels) {
        if (!program.is_optimized())
            log_debug("kernels that are not optimized, for a few rays; 'sahl warm' compiles optimized ones");
        test_before_first_use(on, program, kernels);
        device_scene = make_device_scene(on, scene, job, quality);
    }

    /// Rays of a batch, for `samples` of them in all.
    std::uint32_t batch_size(const RenderSettings& settings, std::uint64_t samples) const {
        const std::uint32_t most = most_rays(device, device_scene.constants.light_count);
        return static_cast<std::uint32_t>(
            std::min({std::uint64_t{settings.ray_budget}, samples, std::uint64_t{most}}));
    }

    /// Renders by kernels that count, walking through the trees that way, by pixel what `by_pixel` has room
    /// for.
    VisitCounter count(const RenderSettings& settings, Traversal traversal, PixelVisits by_pixel,
                       const std::stop_token& stop) {
        const Crop crop = crop_of(settings);
        const std::uint64_t samples = pixel_count(crop) * std::uint64_t(samples_of(settings).count());
        Program counting = build_counting_program(device, traversal, compilation);
        WavefrontKernels counting_kernels(traversal, counting);
        IncoherentIntersect counting_incoherent(device, counting, counting_kernels);
        const bool by_batch = traversal == device.traversal() && incoherent.is_built();
        if (by_batch) counting_incoherent.build(true);
        Film film(device.memory(), crop.x1 - crop.x0, crop.y1 - crop.y0);
        RayQueues queues(device, batch_size(settings, samples), settings.depth,
                         device_scene.constants.light_count);
        VisitCounter visits(device, queues.capacity, settings.depth);
        visits.pixels = std::move(by_pixel);
        Wavefront wavefront{device, counting_kernels, device_scene, queues, &visits};
        if (by_batch) wavefront.incoherent = &counting_incoherent;
        trace_waves(wavefront, camera_constants(cameras[settings.camera], settings.resolution), settings,
                    crop, film, {}, stop, {});
        return visits;
    }

    /// Ray by ray: of packets nobody could say whose nodes they open.
    PixelVisits count_by_pixel(const RenderSettings& settings, std::span<const Aov> costs,
                               const std::stop_token& stop) {
        const auto pixels = [&](Aov aov) {
            const bool wanted = std::find(costs.begin(), costs.end(), aov) != costs.end();
            return std::vector<std::uint32_t>(wanted ? pixel_count(crop_of(settings)) : 0);
        };
        return count(settings, Traversal::scalar, {pixels(Aov::cost_rays), pixels(Aov::cost_nodes)}, stop)
            .pixels;
    }

    std::vector<AovImage> describe(const RenderSettings& settings, std::span<const Aov> aovs) {
        const Crop crop = crop_of(settings);
        RayQueues queues(device, batch_size(settings, pixel_count(crop)), 0, 0);
        Wavefront wavefront{device, kernels, device_scene, queues};
        if (!aov_program) aov_program.emplace(build_aov_program(device, compilation));
        Kernel describing = aov_program->kernel("describe");
        test_before_first_use(device, *aov_program, describing, kernels);
        std::vector<AovImage> images =
            trace_aovs(wavefront, describing, camera_constants(cameras[settings.camera], settings.resolution),
                       settings, crop, aovs);
        aov_program->store_binary();
        return images;
    }

    Device& device;
    Compilation compilation;
    std::vector<Camera> cameras;
    Program program;
    WavefrontKernels kernels;
    IncoherentIntersect incoherent;
    DeviceScene device_scene;
    std::optional<Program> aov_program{};
};

Renderer::Renderer(Device& device, const Scene& scene, const MemoryRequest& job, BuildQuality quality,
                   Compilation compilation)
    : impl_(std::make_unique<Impl>(device, scene, job, quality, compilation)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::set_scene(const Scene& scene, const MemoryRequest& job, BuildQuality quality) {
    impl_->device_scene = {};  // first: there may be no room for two
    impl_->device_scene = make_device_scene(impl_->device, scene, job, quality);
    impl_->cameras = scene.cameras;
}

void Renderer::set_cameras(std::vector<Camera> cameras) { impl_->cameras = std::move(cameras); }

void Renderer::set_job(const MemoryRequest& job) {
    MemoryPlan& plan = impl_->device_scene.plan;
    plan = plan_memory(plan.scene, job, impl_->device.memory().limit());
}

const BvhStatistics& Renderer::bvh_statistics() const { return impl_->device_scene.bvh_statistics; }

const MemoryPlan& Renderer::memory_plan() const { return impl_->device_scene.plan; }

RenderStatistics Renderer::render(const RenderSettings& settings, Film& film,
                                  const ProgressCallback& progress, const std::stop_token& stop,
                                  const Checkpoints& checkpoints) {
    const Crop crop = crop_of(settings);
    if (film.width() != crop.x1 - crop.x0 || film.height() != crop.y1 - crop.y0) {
        throw Error(ExitCode::usage, "the film must have the crop's size");
    }
    const device::CameraConstants camera =
        camera_constants(impl_->cameras[settings.camera], settings.resolution);
    const std::uint64_t samples = pixel_count(crop) * std::uint64_t(samples_of(settings).count());
    std::optional<RayQueues> queues;
    {
        const HostStep step("allocate");
        queues.emplace(impl_->device, impl_->batch_size(settings, samples), settings.depth,
                       impl_->device_scene.constants.light_count);
    }
    Wavefront wavefront{impl_->device, impl_->kernels, impl_->device_scene, *queues};
    wavefront.incoherent = &impl_->incoherent;
    impl_->incoherent.begin_image();
    RenderStatistics statistics =
        trace_waves(wavefront, camera, settings, crop, film, progress, stop, checkpoints);
    const HostStep step("release");
    queues.reset();
    impl_->program.store_binary();  // now that each kernel has been compiled
    impl_->incoherent.store_binary();
    return statistics;
}

std::vector<GenerationVisits> Renderer::count_visits(const RenderSettings& settings) {
    return impl_->count(settings, impl_->device.traversal(), {}, {}).generations;
}

std::vector<AovImage> Renderer::render_aovs(const RenderSettings& settings, std::span<const Aov> aovs,
                                            const std::stop_token& stop) {
    std::vector<Aov> of_first_hits;
    std::copy_if(aovs.begin(), aovs.end(), std::back_inserter(of_first_hits),
                 [](Aov aov) { return !is_cost(aov); });
    std::vector<AovImage> described;
    if (!of_first_hits.empty()) described = impl_->describe(settings, of_first_hits);
    PixelVisits costs;
    if (of_first_hits.size() < aovs.size()) costs = impl_->count_by_pixel(settings, aovs, stop);

    std::vector<AovImage> images;
    auto next = described.begin();
    for (const Aov aov : aovs) {
        if (is_cost(aov)) {
            images.push_back({aov, {}, std::move(aov == Aov::cost_rays ? costs.rays : costs.nodes)});
        } else {
            images.push_back(std::move(*next++));
        }
    }
    return images;
}

Explanation Renderer::explain(const RenderSettings& settings, int x, int y) {
    RenderSettings one = settings;
    one.crop = Crop{x, y, x + 1, y + 1};
    const Crop pixel = crop_of(one);
    const device::CameraConstants camera =
        camera_constants(impl_->cameras[settings.camera], settings.resolution);
    const auto samples = static_cast<std::uint64_t>(samples_of(settings).count());
    // Room for the trees' growth: a batch of its own for each few rays would be slow.
    RayQueues queues(impl_->device, impl_->batch_size(settings, std::max(samples, least_explained_batch)),
                     settings.depth, impl_->device_scene.constants.light_count);
    Wavefront wavefront{impl_->device, impl_->kernels, impl_->device_scene, queues};
    return explain_pixel(wavefront, camera, settings, pixel);
}

}  // namespace sahl
