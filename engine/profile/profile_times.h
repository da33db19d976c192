// The times of a profile that comparisons look at, repetition by repetition.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/profile/profile.h"
#include "engine/profile/timeline.h"

namespace sahl {

/// The times of a whole frame ("wall"), of a kernel over all generations, or of a kernel in one of them.
struct TimedRow {
    std::string kernel;
    std::optional<std::uint32_t> generation;
    std::vector<double> samples_ms;  ///< one a repetition, none below 0
};

/// "wall", "intersect" or "intersect/2".
std::string name_of(const TimedRow& row);

struct ProfileTimes {
    ProfileEnvironment environment;
    std::vector<TimedRow> rows;  ///< wall, then each kernel followed by its generations
};

/// The row of that name; null if there is none.
const TimedRow* find_row(const ProfileTimes& times, const std::string& name);

/// Variants of a kernel count as one: which of them suits a generation's rays may be what has changed.
ProfileTimes times_of(const ProfileEnvironment& environment, const std::vector<TimelineRecord>& frames);

/// The times in a file of `sahl profile --export-json`. Throws Error(scene) naming the file and what is
/// wrong with it: missing, no JSON, no profile, another version of the format.
ProfileTimes read_profile_times(const std::filesystem::path& path);

}  // namespace sahl
