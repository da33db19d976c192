// Two configurations measured side by side, so that what the machine does meanwhile meets both.
//
// Two equal sides are not quite equally fast: each has a device, buffers and pages of memory of its own, and
// what follows from where they lie lasts as long as they do. (Shadow rays of equal kernels: about 1 % apart
// from one making to the next, and 0 where both sides are one object.) No number of frames evens that out,
// but enough of them make it look like a difference that is sure. So both sides are made anew again and
// again, in an order that is drawn: what lasts meets each of them by lot, and a block, the pairs of frames in
// between, counts as one observation (Kalibera and Jones, Rigorous Benchmarking in Reasonable Time, ISMM
// 2013).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "engine/profile/frame_recorder.h"
#include "engine/profile/profile_times.h"

namespace sahl {

/// One of the two: a scene on a device, ready, and what a frame of it is.
struct Contender {
    std::unique_ptr<Device> device;
    std::unique_ptr<Renderer> renderer;  ///< goes before its device
    FrameJob job;
    ProfileEnvironment environment;
};

struct TurnOptions {
    int warm_up = 1;  ///< frames of each side in each block that do not count
    /// Pairs of frames in all; nothing: 15 in each block, but none begun after 3 s of a block, except its
    /// first.
    std::optional<int> pairs{};
};

struct TurnTimes {
    std::array<ProfileTimes, 2> sides;  ///< a repetition is a block, see append_block()
    int pairs = 0;                      ///< of frames, over all blocks
};

/// Records pairs of frames, one of each side, in 20 blocks, or as many as there are pairs. Before each block
/// both sides are made anew, what was made before being gone. Orders, of making and in each pair, are drawn,
/// other ones in each run: this is all that the rank test of pairs assumes. `between_frames` is called before
/// each block and pair; what it throws ends the measurement, as does what `makers` throw.
TurnTimes measure_in_turn(const std::array<std::function<Contender()>, 2>& makers, const TurnOptions& options,
                          const std::function<void()>& between_frames);

}  // namespace sahl
