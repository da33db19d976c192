// The AOVs of an image: one ray a pixel to its first hit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/film/aov.h"
#include "engine/render/wavefront.h"

namespace sahl {

/// Its kernel "describe" turns hits into AOVs.
Program build_aov_program(Device& device, Compilation compilation = Compilation::optimized);

/// Device memory while AOVs are traced in batches of `rays`.
std::size_t aov_queue_bytes(std::uint32_t rays);

/// `aovs`, none of them is_cost(), of sample 0 of the crop's pixels, in their order.
std::vector<AovImage> trace_aovs(Wavefront& wavefront, Kernel& describe,
                                 const device::CameraConstants& camera, const RenderSettings& settings,
                                 const Crop& crop, std::span<const Aov> aovs);

}  // namespace sahl
