// The commands of `sahl`; each adds itself to the command line and says what it runs.
#pragma once

#include <functional>

#include "cli/values.h"

namespace sahl::cli {

struct Command {
    CLI::App* app = nullptr;
    /// To be called after parsing. Failures are Error; the result is the exit status otherwise.
    std::function<ExitCode()> run;
};

/// `common` has to outlive the command.
Command add_render_command(CLI::App& app, CommonOptions& common);
Command add_batch_command(CLI::App& app, CommonOptions& common);
Command add_profile_command(CLI::App& app, CommonOptions& common);
/// To `add_profile_command`'s.
Command add_profile_diff_command(CLI::App& profile, CommonOptions& common);
Command add_warm_command(CLI::App& app, CommonOptions& common);
Command add_explain_command(CLI::App& app, CommonOptions& common);
Command add_compare_command(CLI::App& app, CommonOptions& common);
Command add_convert_command(CLI::App& app, CommonOptions& common);
Command add_info_command(CLI::App& app, CommonOptions& common);
Command add_devices_command(CLI::App& app, CommonOptions& common);
Command add_completion_command(CLI::App& app, CommonOptions& common);
Command add_man_command(CLI::App& app, CommonOptions& common);

}  // namespace sahl::cli
