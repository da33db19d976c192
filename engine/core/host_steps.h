// What the host does and when: named steps, nested, recorded for a profile.
#pragma once

#include <cstdint>
#include <vector>

namespace sahl {

/// Nanoseconds of CLOCK_MONOTONIC_RAW, which no time server bends; PoCL's events have the same.
std::uint64_t monotonic_ns();

/// A step begins, or the last one that began ends.
struct HostEvent {
    std::uint64_t ns = 0;
    const char* begins = nullptr;  ///< the step's name; nullptr: an end
};

/// What another thread did for a step meanwhile.
struct HiddenStep {
    const char* name = nullptr;
    std::uint64_t ns = 0;
};

/// While it lives, the steps of the thread that made it are recorded. One at a time on a thread.
class HostStepLog {
public:
    HostStepLog() { current = this; }
    ~HostStepLog() { current = nullptr; }
    HostStepLog(const HostStepLog&) = delete;
    HostStepLog& operator=(const HostStepLog&) = delete;

    /// What was recorded since the last call, in time's order. A step may be open: it ends in the next.
    std::vector<HostEvent> take();
    /// What add_hidden_step() was told since the last call.
    std::vector<HiddenStep> take_hidden();

private:
    friend class HostStep;
    friend void add_hidden_step(const char* name, std::uint64_t ns);
    constinit static thread_local inline HostStepLog* current = nullptr;

    std::vector<HostEvent> events_;
    std::vector<HiddenStep> hidden_;
};

/// Another thread took `ns` for the step `name`, a literal, while this one, whose log it goes to, did
/// something else.
void add_hidden_step(const char* name, std::uint64_t ns);

/// A step from here to the end of the scope. Costs a look at a pointer where nothing is recorded.
class HostStep {
public:
    /// `name` outlives the log: a literal.
    explicit HostStep(const char* name) : log_(HostStepLog::current) {
        if (log_ != nullptr) log_->events_.push_back({monotonic_ns(), name});
    }
    ~HostStep() {
        if (log_ != nullptr) log_->events_.push_back({monotonic_ns(), nullptr});
    }
    HostStep(const HostStep&) = delete;
    HostStep& operator=(const HostStep&) = delete;

private:
    HostStepLog* log_;
};

}  // namespace sahl
