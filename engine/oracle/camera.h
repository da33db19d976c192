// The rays of camera samples.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "engine/oracle/shape.h"
#include "engine/scene/scene.h"

namespace sahl::oracle {

/// The ray through image position (x, y) in pixels, y down; unit direction.
Ray camera_ray(const Camera& camera, Resolution resolution, double x, double y);

/// Where sample i of `spp` lies in the pixel at (x, y), 0 to 1: the centre for one sample, else a
/// Hammersley point (van der Corput's sequence along x, rows along y), scrambled by pixel and jittered in
/// its row by Philox4x32-10 (Kollig and Keller 2002; Salmon et al. 2011).
glm::dvec2 pixel_sample(std::uint32_t x, std::uint32_t y, std::uint32_t i, std::uint32_t spp,
                        std::uint64_t seed);

}  // namespace sahl::oracle
