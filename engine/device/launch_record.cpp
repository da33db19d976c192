#include "engine/device/launch_record.h"

#include <utility>

#include "engine/device/device_impl.h"

namespace sahl {

LaunchLog::LaunchLog() : impl_(std::make_unique<Impl>()) {}
LaunchLog::~LaunchLog() = default;

void LaunchLog::enable(bool on) { impl_->enabled = on; }

std::vector<LaunchRecord> LaunchLog::take() {
    const std::vector<PendingLaunch> pending = std::exchange(impl_->pending, {});
    std::vector<LaunchRecord> records;
    records.reserve(pending.size());
    if (pending.empty()) return records;
    check_cl(pending.back().event.wait(), "waiting for kernel " + pending.back().kernel);
    for (const PendingLaunch& launch : pending) {
        const auto time = [&](cl_profiling_info what) {
            cl_ulong nanoseconds = 0;
            check_cl(launch.event.getProfilingInfo(what, &nanoseconds),
                     "reading the times of kernel " + launch.kernel);
            return nanoseconds;
        };
        records.push_back({.kernel = launch.kernel,
                           .generation = launch.generation,
                           .items = launch.items,
                           .lanes = launch.lanes,
                           .queued_ns = time(CL_PROFILING_COMMAND_QUEUED),
                           .submitted_ns = time(CL_PROFILING_COMMAND_SUBMIT),
                           .started_ns = time(CL_PROFILING_COMMAND_START),
                           .ended_ns = time(CL_PROFILING_COMMAND_END)});
    }
    return records;
}

}  // namespace sahl
