#include "engine/device/device_clock.h"

#include <algorithm>
#include <limits>

#include "engine/core/host_steps.h"
#include "engine/device/buffer.h"
#include "engine/device/device_impl.h"

namespace sahl {

ClockOffset measure_clock(Device& device) {
    constexpr int commands = 32;
    Buffer word(device, sizeof(std::uint32_t), "clock");
    std::int64_t least = std::numeric_limits<std::int64_t>::min();
    std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const auto time_of = [](const cl::Event& event, cl_profiling_info what) {
        cl_ulong nanoseconds = 0;
        check_cl(event.getProfilingInfo(what, &nanoseconds), "reading the device's clock");
        return static_cast<std::int64_t>(nanoseconds);
    };
    device.finish();
    for (int i = 0; i < commands; ++i) {
        const std::uint32_t value = 0;
        cl::Event event;
        const auto before = static_cast<std::int64_t>(monotonic_ns());
        check_cl(device.impl().queue.enqueueWriteBuffer(word.impl()->buffer, CL_TRUE, 0, sizeof(value),
                                                        &value, nullptr, &event),
                 "asking for the device's clock");
        const auto after = static_cast<std::int64_t>(monotonic_ns());
        least = std::max(least, before - time_of(event, CL_PROFILING_COMMAND_START));
        most = std::min(most, after - time_of(event, CL_PROFILING_COMMAND_END));
    }
    if (least <= 0 && most >= 0) return {0, std::max(-least, most)};
    return {least + (most - least) / 2, std::max<std::int64_t>((most - least + 1) / 2, 0)};
}

}  // namespace sahl
