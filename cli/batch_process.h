// A worker's process, seen from its supervisor.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "cli/batch_messages.h"
#include "cli/batch_setup.h"

namespace sahl::cli {

/// This program once more (fork and exec) with run_batch_worker, which ends with this one whatever ends it. A
/// mere copy (fork) would be quicker, but without the threads that libraries start before main(), and with
/// whatever they held.
class WorkerProcess {
public:
    /// Throws Error(memory) if there is no room for another process.
    explicit WorkerProcess(const WorkerSettings& settings);
    /// Kills it.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    MessageSocket& socket() { return socket_; }
    /// What it has written to standard output and error since the last call.
    std::string take_log();
    void kill();
    /// Waits for its end. In words that follow a subject: "ended with status 4", "crashed (Segmentation
    /// fault)".
    std::string wait();

private:
    pid_t id_ = -1;
    MessageSocket socket_;
    int log_;
};

/// The socket that the arguments of a worker's process name; nothing for any other process.
std::optional<int> worker_socket(int argc, char** argv);

}  // namespace sahl::cli
