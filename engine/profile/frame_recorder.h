// Records what device and host do in a frame, or before the first.
#pragma once

#include <filesystem>
#include <optional>

#include "engine/device/device_clock.h"
#include "engine/film/image_io.h"
#include "engine/profile/timeline.h"
#include "engine/render/renderer.h"

namespace sahl {

/// Records from its construction until stop(), on this thread. One at a time.
class TimelineRecorder {
public:
    TimelineRecorder() : begin_ns_(monotonic_ns()) {}

    /// Launches of `device` are recorded from here on.
    void add(Device& device);

    /// Waits for the device. `clock`: of the device.
    TimelineRecord stop(Device& device, const ClockOffset& clock);

private:
    HostStepLog steps_;
    std::uint64_t begin_ns_;
};

/// A frame: rendered, resolved, encoded, written.
struct FrameJob {
    RenderSettings settings;
    std::filesystem::path output;  ///< /dev/null: encoded as PNG and thrown away
    OutputSettings encoding;
};

/// Does a frame's work as it is without a profile. Errors as of Renderer::render and write_image.
RenderStatistics run_frame(Device& device, Renderer& renderer, const FrameJob& job);

struct RecordedFrame {
    TimelineRecord timeline;
    RenderStatistics statistics;
    ClockOffset clock;
    std::uint64_t processor_ns = 0;  ///< that this process took for it
};

/// Processor time of this process so far, of all its threads.
std::uint64_t processor_ns();

/// The same, recorded. The device's clock is measured before.
RecordedFrame record_frame(Device& device, Renderer& renderer, const FrameJob& job);

}  // namespace sahl
