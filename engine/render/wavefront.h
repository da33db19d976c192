// The wavefront loop: ray batches, one kernel after the other, generation by generation.
#pragma once

#include "engine/film/film.h"
#include "engine/render/launches.h"
#include "engine/render/renderer.h"

namespace sahl {

/// All samples of the crop's pixels as a wave; `first` and `count` are still to be filled in.
device::WaveConstants wave_constants(const RenderSettings& settings, const Crop& crop);

/// Generates all camera samples of `settings`, wave by wave, follows their ray trees and adds every
/// contribution to `film`. Looks at `stop` before each generation, see Renderer::render; at `checkpoints`
/// between waves.
RenderStatistics trace_waves(Wavefront& wavefront, const device::CameraConstants& camera,
                             const RenderSettings& settings, const Crop& crop, Film& film,
                             const ProgressCallback& progress, const std::stop_token& stop,
                             const Checkpoints& checkpoints);

}  // namespace sahl
