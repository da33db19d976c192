// The worker of a batch: the process that renders.
#pragma once

namespace sahl::cli {

/// Renders the jobs that the other end of `socket` describes until that is closed or says stop; then ends the
/// process. To be called in a process of its own.
///
/// It is told what batch_order.h says, and {"stop": true}; it says, N being a job,
///   {"taken": N}                     another process has it; only without "wait"
///   {"finished": N}                  another process has made it by now
///   {"started": N}                   it has it
///   {"progress": N, "done", "total"} camera samples, a few times a second
///   {"resumed": N, "done", "total"}  it goes on from a checkpoint
///   {"rendered": N, "seconds", "loaded", "built", "rays", "shadow_rays", "non_finite", "clamped"}    and
///   could take another
///   {"written": N}                   all files are there
///   {"failed": N, "code", "message"} could take another too, unless it was rendered before
///   {"stopped": N, "checkpoint"}     it was told to stop in the midst of it
[[noreturn]] void run_batch_worker(int socket);

}  // namespace sahl::cli
