// What of a scene is rendered, and how.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

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

}  // namespace sahl
