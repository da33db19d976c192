// How the clock of a device's events goes beside the host's.
#pragma once

#include <cstdint>

#include "engine/device/device.h"

namespace sahl {

/// host = device + offset_ns, of monotonic_ns().
struct ClockOffset {
    std::int64_t offset_ns = 0;
    std::int64_t uncertainty_ns = 0;  ///< the true offset is at most this far away
};

/// Measures it by commands whose times the host's own before and after enclose. 0 where that may be the
/// offset, as on devices that read the host's clock. Waits for the queue.
ClockOffset measure_clock(Device& device);

}  // namespace sahl
