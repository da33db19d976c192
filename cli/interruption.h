// SIGINT and SIGTERM: when they end the program, and how it can save its work first.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

namespace sahl::cli {

/// From now on the first SIGINT or SIGTERM ends the process with a message, exit status 128 + signal
/// and no temporary files left; the second one ends it at once. A signal that is ignored (nohup,
/// background jobs) stays so. Call once, before the process has threads: it blocks the signals in all
/// of them, whatever handlers libraries install (LLVM's would end the process), and waits for them in
/// a thread of its own.
void take_signals();

/// The message of an interruption is an event of the `--json` stream too.
void report_interruption_as_event();

/// There is something to save or to finish: the first signal is only noted from now on.
void defer_interruption();

/// Stopped by the first signal.
std::stop_token interruption();

/// The end of work that noted the signal. `what()` says what has been saved, and where.
struct Interrupted : std::runtime_error {
    explicit Interrupted(const std::string& what, std::vector<std::filesystem::path> partial = {});
    std::vector<std::filesystem::path> partial_images;
};

/// Says it on standard error and as an event. Returns the exit status.
int report(const Interrupted& interrupted);

}  // namespace sahl::cli
