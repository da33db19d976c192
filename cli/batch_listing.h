// What `sahl batch --dry-run` and `--check` say.
#pragma once

#include <vector>

#include "cli/batch_outcome.h"
#include "cli/batch_setup.h"

namespace sahl::cli {

/// Every output with its settings and whether it is finished; then for each scene the memory plan, and an
/// estimate of the time, for which a few samples of it are rendered. Returns what the first scene that cannot
/// be loaded ends with.
ExitCode print_batch_plan(BatchSetup& setup, const std::vector<JobOutcome>& outcomes, bool json);

/// The outputs that are not finished, and why. Returns ExitCode::resume_mismatch if there are any.
ExitCode print_batch_check(const BatchSetup& setup, const std::vector<JobOutcome>& outcomes, bool json);

}  // namespace sahl::cli
