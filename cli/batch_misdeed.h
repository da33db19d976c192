// Crashes, hangs and greed on demand: how tests see what a batch does about them.
#pragma once

#include "engine/batch/batch_job.h"

namespace sahl::cli {

/// Does what the environment variable SAHL_FAIL_JOB says, if it is meant for `job`: "crash:TEXT", "hang:TEXT"
/// or "memory:TEXT", where TEXT is a part of the job's first output.
void misbehave_if_asked(const BatchJob& job);

}  // namespace sahl::cli
