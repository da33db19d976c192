// Runs a program as a user would: arguments, environment, working folder; catches what it writes
// and how it ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
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
    std::string out;
    std::string err;
};

/// Runs `command` (a path first) to its end, or kills it after the timeout.
/// Throws std::system_error when it cannot be started.
ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options = {});

}  // namespace sahl::tests
