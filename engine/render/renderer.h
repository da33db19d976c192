// Renders a scene on a device: the engine's front door.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/device/device.h"
#include "engine/film/aov.h"
#include "engine/film/film.h"
#include "engine/render/explanation.h"
#include "engine/render/memory_plan.h"
#include "engine/render/render_settings.h"
#include "engine/render/visits.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Rays that were traced in one bounce generation, over all waves.
struct GenerationCounts {
    std::uint64_t rays = 0;
    std::uint64_t shadow_rays = 0;
};

struct RenderStatistics {
    std::vector<GenerationCounts> generations;  ///< [0]: camera rays
    double seconds = 0;                         ///< from the first launch to the last contribution
    std::uint64_t finished_pixels = 0;          ///< all, unless it was stopped
};

/// Called with the camera samples finished so far and their whole number, after each wave.
using ProgressCallback = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// For renders that go on where an earlier one was ended.
struct Checkpoints {
    std::uint64_t first_sample = 0;  ///< camera samples that the film has already, see `save`
    std::function<bool()> due{};     ///< asked between waves; none: never
    /// Called when it is due, with the number of camera samples that are in the film: with it as
    /// `first_sample` and the film as it is now, the rest makes the same image bit for bit.
    std::function<void(std::uint64_t samples)> save{};
};

/// For the kernels of `images` images that ask for as much as `job`: quick ones if they have no more rays
/// than those trace in the blink of an eye.
Compilation compilation_for(const MemoryRequest& job, std::size_t images = 1);

/// A scene made ready for a device: lowered, its BVH built, uploaded, kernels compiled.
class Renderer {
public:
    /// Throws Error(scene) for what the loaders cannot see (no primitive limit exceeded, finite
    /// bounds), Error(device) from below, and Error(memory) naming what would be enough when the scene and
    /// `job` do not fit within the limit of the device's accountant. `device` must outlive the renderer.
    Renderer(Device& device, const Scene& scene, const MemoryRequest& job = {},
             BuildQuality quality = BuildQuality::high, Compilation compilation = Compilation::optimized);
    ~Renderer();
    Renderer(Renderer&&) noexcept;

    /// Takes another scene in the place of this one; kernels stay as they are. Errors as of the constructor:
    /// then there is no scene, and a call of this has to follow.
    void set_scene(const Scene& scene, const MemoryRequest& job = {},
                   BuildQuality quality = BuildQuality::high);
    /// Takes other cameras; nothing is built again.
    void set_cameras(std::vector<Camera> cameras);
    /// Plans the memory of another job with the scene that there is. Throws Error(memory) as plan_memory.
    void set_job(const MemoryRequest& job);

    const BvhStatistics& bvh_statistics() const;
    /// Of the scene and the job.
    const MemoryPlan& memory_plan() const;

    /// Adds the image of `settings` into `film` (of the crop's size).
    /// A requested `stop` is heard within a generation of one batch. The pixels that are finished by then
    /// are in the film as in the whole image, of the others nothing is: in a new film they are black.
    RenderStatistics render(const RenderSettings& settings, Film& film, const ProgressCallback& progress = {},
                            const std::stop_token& stop = {}, const Checkpoints& checkpoints = {});

    /// What the rays of the image of `settings` visit, by generation, with the kernels that were needed so
    /// far. Compiles kernels that count.
    std::vector<GenerationVisits> count_visits(const RenderSettings& settings);

    /// What `aovs` ask for, in their order, of the camera, the crop and the samples of `settings`; costs also
    /// of the depth. Costs take a render by kernels that count, which heeds `stop` as render() does.
    std::vector<AovImage> render_aovs(const RenderSettings& settings, std::span<const Aov> aovs,
                                      const std::stop_token& stop = {});

    /// Where the light of pixel (x, y) of the image of `settings` comes from, ray by ray: the same rays, bit
    /// for bit, that render() adds up there. Its crop does not count.
    Explanation explain(const RenderSettings& settings, int x, int y);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sahl
