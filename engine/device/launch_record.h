// What ran on the device and when: one record a kernel launch.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sahl {

/// Times are nanoseconds of the device's event clock.
struct LaunchRecord {
    std::string kernel;
    std::uint32_t generation = 0;
    std::uint64_t items = 0;  ///< rays (or slots) that the launch worked on
    std::uint64_t lanes = 0;  ///< places for them, padding included
    std::uint64_t queued_ns = 0;
    std::uint64_t submitted_ns = 0;
    std::uint64_t started_ns = 0;
    std::uint64_t ended_ns = 0;
};

/// Collects the events of named launches while it is enabled. It starts disabled: an event that
/// nobody takes would be memory that grows with every launch.
class LaunchLog {
public:
    LaunchLog();
    ~LaunchLog();

    void enable(bool on);

    /// Records of all recorded launches since the last call, in launch order. Waits for the last of them.
    std::vector<LaunchRecord> take();

    struct Impl;  ///< for engine/device alone
    Impl& impl() { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace sahl
