#include "cli/interruption.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <initializer_list>
#include <mutex>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/standard_output.h"
#include "engine/core/log.h"
#include "engine/device/device.h"
#include "engine/sahl.h"

namespace sahl::cli {

namespace {

struct State {
    std::mutex mutex;  ///< of `deferred`; kept for good by the thread that ends the process
    bool deferred = false;
    std::atomic<bool> events = false;
    std::atomic<int> signal = 0;
    std::stop_source stop;
};

/// Never destroyed: the thread that waits for signals is there until the process ends.
State& state() {
    static State* const instance = new State;
    return *instance;
}

std::string_view signal_name(int signal) { return signal == SIGINT ? "SIGINT" : "SIGTERM"; }

int exit_status(int signal) { return 128 + signal; }

/// Async-signal-safe.
void end_at_once(int signal) { _exit(exit_status(signal)); }

/// In this thread alone, which does not go away; the others keep them blocked.
void end_at_once_on(const sigset_t& signals) {
    for (const int signal : {SIGINT, SIGTERM}) {
        if (sigismember(&signals, signal) == 1) std::signal(signal, end_at_once);
    }
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

void wait_for_signal(const sigset_t& signals) {
    int signal = 0;
    sigwait(&signals, &signal);
    // First of all: what follows may block, as when nobody reads standard output.
    end_at_once_on(signals);
    State& common = state();
    common.signal = signal;
    {
        const std::lock_guard lock(common.mutex);
        if (!common.deferred) {
            // Another thread may be stuck in its output, with the lock.
            if (ftrylockfile(stdout) != 0) common.events = false;
            exit_at_once(report(Interrupted("nothing was written")));
        }
    }
    common.stop.request_stop();
    for (;;) pause();
}

}  // namespace

void take_signals() {
    sigset_t signals;
    sigset_t blocked;
    sigemptyset(&signals);
    sigemptyset(&blocked);
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        sigaddset(&blocked, signal);
        if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
    }
    pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
    if (sigismember(&signals, SIGINT) == 1 || sigismember(&signals, SIGTERM) == 1) {
        std::thread(wait_for_signal, signals).detach();
    }
}

void report_interruption_as_event() { state().events = true; }

void defer_interruption() {
    const std::lock_guard lock(state().mutex);
    state().deferred = true;
}

std::stop_token interruption() { return state().stop.get_token(); }

Interrupted::Interrupted(const std::string& what, std::vector<std::filesystem::path> partial)
    : std::runtime_error(what), partial_images(std::move(partial)) {}

int report(const Interrupted& interrupted) {
    const int signal = state().signal;
    const std::string message = fmt::format("interrupted by {}: {}", signal_name(signal), interrupted.what());
    log_error(message);
    if (!state().events) return exit_status(signal);
    nlohmann::ordered_json partial = nlohmann::ordered_json::array();
    for (const std::filesystem::path& path : interrupted.partial_images) partial.push_back(path.string());
    try {
        print_event({{"event", "interrupted"},
                     {"code", exit_status(signal)},
                     {"signal", signal_name(signal)},
                     {"partial", partial},
                     {"message", message}});
    } catch (const Error&) {
        // Standard error has said it.
    }
    return exit_status(signal);
}

}  // namespace sahl::cli
