// Traces one pixel and keeps what each kernel found.
#pragma once

#include "engine/render/explanation.h"
#include "engine/render/launches.h"
#include "engine/render/render_settings.h"

namespace sahl {

/// The ray tree of the pixel that is the whole crop of `settings`. Its rays are traced by the kernels of a
/// render, with the same bits, whatever pixels are traced beside them.
Explanation explain_pixel(Wavefront& wavefront, const device::CameraConstants& camera,
                          const RenderSettings& settings, const Crop& pixel);

}  // namespace sahl
