// A frame's wall clock taken apart: what the device did, and the host's steps while it did nothing.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/core/host_steps.h"
#include "engine/device/launch_record.h"

namespace sahl {

/// What was recorded between two moments, all on the clock of monotonic_ns().
struct TimelineRecord {
    std::uint64_t begin_ns = 0;
    std::uint64_t end_ns = 0;
    std::vector<LaunchRecord> launches;  ///< in the order they ran
    std::vector<HostEvent> steps;
    std::vector<HiddenStep> hidden{};  ///< by other threads: in the steps' totals, never exposed
};

/// Nanoseconds in milliseconds.
inline double in_ms(std::uint64_t ns) { return static_cast<double>(ns) * 1e-6; }

/// A stretch of time in which one host step is the innermost.
struct HostSegment {
    std::uint64_t begin_ns = 0;
    std::uint64_t end_ns = 0;
    const char* step = nullptr;  ///< nullptr: none
};

/// The record's time from begin to end without a gap.
std::vector<HostSegment> host_segments(const TimelineRecord& record);

struct HostStepTime {
    std::uint64_t calls = 0;
    std::uint64_t total_ns = 0;    ///< without the steps within it
    std::uint64_t exposed_ns = 0;  ///< of that: the device was idle
};

/// busy + idle = end - begin, and the steps' exposed_ns + unattributed = idle.
struct TimelineSums {
    std::uint64_t busy_ns = 0;  ///< at least one launch ran
    std::uint64_t idle_ns = 0;
    std::uint64_t unattributed_ns = 0;  ///< idle, and no step
    std::map<std::string, HostStepTime> steps;
};

TimelineSums add_up(const TimelineRecord& record);

}  // namespace sahl
