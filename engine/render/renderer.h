// Renders a scene on a device: the engine's front door.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/device/device.h"
#include "engine/film/aov.h"
#include "engine/film/film.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Pixels x0 <= x < x1, y0 <= y < y1 of the image, y down.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Samples begin <= i < end of each pixel.
struct SampleRange {
    int begin = 0, end = 0;

    int count() const { return end - begin; }
};

struct RenderSettings {
    Resolution resolution;
    int depth = 5;  ///< generations after the camera ray; 0 is ray casting
    int spp = 1;    ///< samples a pixel, 1..16384; 1 samples the pixel's centre
    std::uint64_t seed = 0;
    std::size_t camera = 0;              ///< in Scene::cameras
    std::optional<SampleRange> samples;  ///< a part of the spp; none: all of them
    std::optional<Crop> crop;            ///< none: the whole image
    /// Rays of a batch. Does not change the image: what does not fit waits.
    std::uint32_t ray_budget = 1u << 15;
};

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

/// A scene made ready for a device: lowered, its BVH built, uploaded, kernels compiled.
class Renderer {
public:
    /// Throws Error(scene) for what the loaders cannot see (no primitive limit exceeded, finite
    /// bounds), Error(device) and Error(memory) from below. `device` must outlive the renderer.
    Renderer(Device& device, const Scene& scene);
    ~Renderer();
    Renderer(Renderer&&) noexcept;

    const BvhStatistics& bvh_statistics() const;

    /// Adds the image of `settings` into `film` (of the crop's size).
    /// A requested `stop` is heard within a generation of one batch. The pixels that are finished by then
    /// are in the film as in the whole image, of the others nothing is: in a new film they are black.
    RenderStatistics render(const RenderSettings& settings, Film& film, const ProgressCallback& progress = {},
                            const std::stop_token& stop = {});

    /// What `aovs` ask for, of the camera, the crop and the samples of `settings`.
    std::vector<AovImage> render_aovs(const RenderSettings& settings, std::span<const Aov> aovs);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sahl
