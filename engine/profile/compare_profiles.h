// Two profiles side by side: which rows are faster or slower by more than chance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/profile/profile_times.h"
#include "engine/profile/statistics.h"

namespace sahl {

/// The most probability that one verdict or more of a comparison is a false alarm, all of its rows together.
constexpr double comparison_level = 0.01;

/// Of all rows those are tested that take at least this share of a frame on either side. What is less cannot
/// matter much, and each row more makes it harder to be sure of the others.
constexpr double least_tested_share = 0.01;

enum class SpeedVerdict { no_difference, faster, slower };

struct RowComparison {
    TimedRow row;         ///< without its times
    double base_ms = 0;   ///< median
    double other_ms = 0;  ///< median
    double ratio = 0;     ///< ratio_of(): above 1 where the other side takes longer
    Interval interval;    ///< 95 %, of this row alone
    /// By the rank test, adjusted over all rows that are tested; nothing for rows that are not.
    std::optional<double> p_value;
    SpeedVerdict verdict = SpeedVerdict::no_difference;
};

struct ProfileComparison {
    std::vector<RowComparison> rows;     ///< those that both sides have
    std::vector<std::string> unmatched;  ///< rows that one side alone has
    std::size_t tested = 0;
    bool too_few_repetitions = false;  ///< so few that no row could have been faster or slower
};

/// `paired`: both sides ran in turn, as TwoSides says. A verdict other than no_difference takes an adjusted p
/// value of at most comparison_level, and an interval that 1 lies outside of.
ProfileComparison compare_profiles(const ProfileTimes& base, const ProfileTimes& other, bool paired);

/// "ROW takes at most `percent` % longer than in the base."
struct SlowdownLimit {
    std::string row;  ///< name_of()
    double percent = 0;
};

struct LimitResult {
    SlowdownLimit limit;
    double ratio = 0;
    Interval interval;
    double p_value =
        1;  ///< of what was measured, were the row exactly at its limit; adjusted over all limits
    bool exceeded = false;
};

/// Whether rows are slower than they may be: more than the limit, by more than chance. One false alarm or
/// more has a probability of at most comparison_level. Throws Error(usage) for a row that the sides do not
/// both have, and for so few repetitions that no slowdown whatever could exceed the limits.
std::vector<LimitResult> check_limits(const ProfileTimes& base, const ProfileTimes& other, bool paired,
                                      const std::vector<SlowdownLimit>& limits);

/// In what the profiles differ that makes their times no comparison of programs: the scene and how it is
/// rendered, device, driver. "depth: 5, 3", one a line; empty where nothing does.
std::string incomparable(const ProfileEnvironment& base, const ProfileEnvironment& other);

}  // namespace sahl
