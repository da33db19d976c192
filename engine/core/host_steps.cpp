#include "engine/core/host_steps.h"

#include <time.h>  // NOLINT: clock_gettime

#include <utility>

namespace sahl {

std::uint64_t monotonic_ns() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC_RAW, &time);
    return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(time.tv_nsec);
}

std::vector<HostEvent> HostStepLog::take() { return std::exchange(events_, {}); }

}  // namespace sahl
