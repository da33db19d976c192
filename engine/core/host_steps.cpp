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

std::vector<HiddenStep> HostStepLog::take_hidden() { return std::exchange(hidden_, {}); }

void add_hidden_step(const char* name, std::uint64_t ns) {
    if (HostStepLog::current != nullptr) HostStepLog::current->hidden_.push_back({name, ns});
}

}  // namespace sahl
