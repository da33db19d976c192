// Gives the jobs of a batch to a worker process, and goes on whatever becomes of that.
#pragma once

#include <vector>

#include "cli/batch_outcome.h"
#include "cli/batch_report.h"
#include "cli/batch_setup.h"

namespace sahl::cli {

/// Renders all jobs whose outcome is `waiting`. A worker that crashes, runs out of memory or is silent for
/// `hang_seconds` is replaced and its job tried once more, alone; then the job has failed, and what the
/// worker said is kept beside its first output as `NAME.log`.
BatchEnd run_batch(BatchSetup& setup, std::vector<JobOutcome>& outcomes, double hang_seconds,
                   BatchReport& report);

}  // namespace sahl::cli
