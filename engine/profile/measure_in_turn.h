// Two configurations measured side by side, so that what the machine does meanwhile meets both.
#pragma once

#include <array>
#include <functional>

#include "engine/profile/frame_recorder.h"
#include "engine/profile/profile_times.h"

namespace sahl {

/// One of the two: a scene on a device, ready, and what a frame of it is.
struct Contender {
    Device& device;
    Renderer& renderer;
    FrameJob job;
    ProfileEnvironment environment;
};

/// Records `pairs` frames of each after `warm_up` that are not. In each pair the order is drawn (the same
/// draws each time), which is all that the rank test of pairs assumes.
/// `between_frames` is called before each pair; what it throws ends the measurement.
std::array<ProfileTimes, 2> measure_in_turn(const std::array<Contender, 2>& contenders, int warm_up,
                                            int pairs, const std::function<void()>& between_frames);

}  // namespace sahl
