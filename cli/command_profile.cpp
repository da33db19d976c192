// `sahl profile`: where the time of a frame goes.
#include "cli/commands.h"

namespace sahl::cli {

Command add_profile_command(CLI::App& app, CommonOptions& common) {
    CLI::App* command = app.add_subcommand("profile", "compares profiles");
    add_common_options(*command, common);
    command->footer(
        "Examples:\n"
        "  sahl profile diff before.json after.json");
    return {command, []() -> ExitCode {
                throw Error(ExitCode::usage,
                            "which command? diff; 'sahl profile --help' shows what there is");
            }};
}

}  // namespace sahl::cli
