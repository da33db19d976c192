// `sahl profile --ab`: two settings measured in turn in one run.
#pragma once

#include "cli/profile_options.h"

namespace sahl::cli {

/// `--ab` and `--fail-if`. `options` has to outlive `command`.
void add_ab_options(CLI::App& command, AbOptions& options);

/// Prepares the scene once for each setting, measures both, says what differs. Returns the exit status.
ExitCode run_ab(const ProfileOptions& options, const CommonOptions& common);

}  // namespace sahl::cli
