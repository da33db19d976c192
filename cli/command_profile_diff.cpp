// `sahl profile diff`: two profiles that are in files.
#include <memory>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/profile_diff_report.h"
#include "engine/core/log.h"

namespace sahl::cli {

namespace {

struct DiffOptions {
    std::string base;
    std::string other;
    std::vector<SlowdownLimit> limits;
    bool force = false;
};

ExitCode diff_files(const DiffOptions& options, const CommonOptions& common) {
    const ProfileTimes base = read_profile_times(options.base);
    const ProfileTimes other = read_profile_times(options.other);
    if (const std::string differences = incomparable(base.environment, other.environment);
        !differences.empty()) {
        const std::string message =
            fmt::format("{} and {} are of different work:\n{}", options.base, options.other, differences);
        if (!options.force) throw Error(ExitCode::usage, message + "--force compares them nevertheless");
        log_warning(message + "they are compared because of --force");
    }
    log_warning(
        "the two profiles were not measured in turn: what has changed in the machine meanwhile (clock rates, "
        "other programs) counts as a difference too; 'sahl profile --ab' excludes that");
    return report(diff_profiles(options.base, base, options.other, other, 0, options.limits), common);
}

}  // namespace

Command add_profile_diff_command(CLI::App& profile, CommonOptions& common) {
    const auto options = std::make_shared<DiffOptions>();
    CLI::App* command = profile.add_subcommand("diff", "compares two profiles");
    command->add_option("A", options->base, "the base, a file of --export-json")
        ->required()
        ->type_name("FILE");
    command->add_option("B", options->other, "what is compared with it")->required()->type_name("FILE");
    add_fail_if_option(*command, options->limits);
    command->add_flag("--force", options->force, "compares what differs in scene, settings or device too");
    add_common_options(*command, common);
    command->footer(
        "A row is a kernel, a kernel in one generation (intersect/2), or the whole frame (wall). It is "
        "faster or\n"
        "slower where the rank sum test says so: over all rows that are tested, one false verdict or more "
        "has a\n"
        "probability of at most 1 % (Holm). Change is of medians, with its 95 % bootstrap interval.\n"
        "Exit status 9: a row is slower than its --fail-if allows.\n"
        "Examples:\n"
        "  sahl profile diff before.json after.json\n"
        "  sahl profile diff before.json after.json --fail-if intersect:+3% --fail-if wall:+1%");
    return {command, [options, &common] { return diff_files(*options, common); }};
}

}  // namespace sahl::cli
