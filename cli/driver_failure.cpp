#include "cli/driver_failure.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "engine/device/device.h"
#include "engine/sahl.h"

namespace sahl::cli {

namespace {

#define SAHL_DRIVER_FAILURE                                                                             \
    "the OpenCL driver gave up, its own words are above: PoCL needs a folder for temporary files that " \
    "can be written and has 32 MiB free; free some space or set TMPDIR to another folder"

// Ready-made, for there is a signal handler among those that need them.
constexpr std::string_view failure_message = "sahl: error: " SAHL_DRIVER_FAILURE "\n";
constexpr std::string_view failure_event =
    "{\"event\":\"error\",\"code\":4,\"message\":\"" SAHL_DRIVER_FAILURE "\"}\n";

std::atomic<bool> as_event = false;
std::atomic<bool> ending = false;

void write_whole(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Async-signal-safe.
[[noreturn]] void give_up() {
    write_whole(STDERR_FILENO, failure_message);
    if (as_event) write_whole(STDOUT_FILENO, failure_event);
    exit_at_once(static_cast<int>(ExitCode::device));
}

void on_abort(int /*signal*/) {
    if (driver_lacks_room()) give_up();
    // abort() goes on when its signal's handler returns.
}

void on_exit() {
    if (!ending) give_up();
}

}  // namespace

void take_driver_failures() {
    std::signal(SIGABRT, on_abort);
    std::atexit(on_exit);
}

void report_driver_failure_as_event() { as_event = true; }

void expect_end() { ending = true; }

}  // namespace sahl::cli
