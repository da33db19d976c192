// Measures frames until their median can be trusted.
#pragma once

#include <functional>
#include <optional>

#include "engine/profile/frame_recorder.h"
#include "engine/profile/summarize.h"

namespace sahl {

struct MeasureOptions {
    int warm_up = 1;
    /// Repetitions; nothing: until the 95 % confidence interval of the median wall time is within 1 % either
    /// way, 10 seconds are over or there are 100, but at least 7.
    std::optional<int> repeat{};
};

/// Warms up, records frames, counts what rays visit and calibrates the device. Fills all of a measurement
/// but its setup, compiles_in_setup and the parts of its environment that only the caller knows.
/// `between_frames` is called before each frame; what it throws ends the measurement.
/// Throws Error(internal) when frames do not trace the same rays, and as all that it calls.
Measurement measure(Device& device, Renderer& renderer, const FrameJob& job, const MeasureOptions& options,
                    const std::function<void()>& between_frames);

}  // namespace sahl
