// What is said of two profiles: `sahl profile diff` and `sahl profile --ab`.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/values.h"

namespace sahl::cli {

/// Both sides, compared.
struct ProfileDiff {
    std::string base_name;  ///< a file or a setting
    std::string other_name;
    ProfileEnvironment base;
    ProfileEnvironment other;
    std::size_t base_repetitions = 0;  ///< blocks, where both ran in turn
    std::size_t other_repetitions = 0;
    int pairs = 0;  ///< of frames that ran in turn; 0: the sides are of two runs
    ProfileComparison comparison;
    std::vector<LimitResult> limits;
};

ProfileDiff diff_profiles(const std::string& base_name, const ProfileTimes& base,
                          const std::string& other_name, const ProfileTimes& other, int pairs,
                          const std::vector<SlowdownLimit>& limits);

/// `--fail-if ROW:+P%`, several times.
void add_fail_if_option(CLI::App& command, std::vector<SlowdownLimit>& limits);

/// The table on standard output, or the event of `--json`. Returns the exit status.
ExitCode report(const ProfileDiff& diff, const CommonOptions& common);

}  // namespace sahl::cli
