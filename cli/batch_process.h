// A worker's process, seen from its supervisor.
#pragma once

#include <sys/types.h>

#include <string>

#include "cli/batch_messages.h"
#include "cli/batch_setup.h"

namespace sahl::cli {

/// Runs run_batch_worker in a process of its own, which ends with this one whatever ends it. That is a copy
/// of this process (fork), which therefore must have used neither OpenCL nor threads that do work: so the
/// worker knows all jobs, and begins at once.
class WorkerProcess {
public:
    /// Throws Error(memory) if there is no room for another process.
    explicit WorkerProcess(BatchSetup& setup);
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

}  // namespace sahl::cli
