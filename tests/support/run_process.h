// Runs a program as a user would: arguments, environment, working folder; catches what it writes
// and how it ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sahl::tests {

struct ProcessOptions {
    /// Set for the child on top of this process's environment; no value: unset.
    std::map<std::string, std::optional<std::string>> environment;
    std::filesystem::path working_directory;  ///< empty: this process's
    /// Standard output goes into this file (such as /dev/full) instead of ProcessResult::out.
    std::filesystem::path standard_output;
    /// Standard output is a pipe that nobody reads any more.
    bool broken_pipe = false;
    std::chrono::seconds timeout{120};
};

struct ProcessResult {
    int status = -1;  ///< exit status, or 128 + n after signal n
    bool timed_out = false;
    std::size_t peak_bytes = 0;  ///< the most memory that was resident
    std::string out;
    std::string err;
};

/// A program that runs. Killed and waited for at destruction if it has not been finished.
class Process {
public:
    /// Starts `command` (a path first). Throws std::system_error when it cannot be started.
    explicit Process(const std::vector<std::string>& command, const ProcessOptions& options = {});
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    pid_t id() const;
    void send_signal(int number) const;
    /// Reads what it writes until a whole line of standard output is there; false at its end.
    bool wait_for_output();
    /// Waits for its end, or kills it `timeout` after the start.
    ProcessResult finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Processes that the first thread of `parent` has started.
std::vector<pid_t> children_of(pid_t parent);

/// Waits for it, a minute at most.
bool comes_true(const std::function<bool()>& condition);

/// Runs `command` to its end.
ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options = {});

}  // namespace sahl::tests
