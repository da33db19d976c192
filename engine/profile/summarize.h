// From recorded frames to a profile.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/profile/profile.h"
#include "engine/profile/timeline.h"
#include "engine/render/renderer.h"

namespace sahl {

/// All that was recorded and counted. Frames trace the same rays.
struct Measurement {
    ProfileEnvironment environment;
    Calibration calibration;
    TimelineRecord setup;
    std::vector<TimelineRecord> frames;         ///< at least one
    std::vector<GenerationCounts> generations;  ///< of a frame
    std::vector<GenerationVisits> visits;       ///< of a frame, as many
    std::uint32_t lights = 0;                   ///< of the scene
    std::uint64_t compiles_during_render = 0;
    std::uint64_t compiles_in_setup = 0;
};

/// Rows in the order of the pipeline, generation by generation.
/// Throws Error(internal) where the time of a frame does not add up.
Profile summarize(const Measurement& measurement);

}  // namespace sahl
