#include "engine/profile/compare_profiles.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/nearest.h"
#include "engine/profile/rank_tests.h"

namespace sahl {
namespace {

RowComparison compare_rows(const TimedRow& row, const TwoSides& times) {
    return {{row.kernel, row.generation, {}}, median(times.base), median(times.other), ratio_of(times),
            bootstrap_interval(times),        std::nullopt};
}

SpeedVerdict verdict_of(const RowComparison& row) {
    if (!row.p_value || *row.p_value > comparison_level) return SpeedVerdict::no_difference;
    if (row.interval.low > 1) return SpeedVerdict::slower;
    return row.interval.high < 1 ? SpeedVerdict::faster : SpeedVerdict::no_difference;
}

std::size_t repetitions(const ProfileTimes& times) { return times.rows.front().samples_ms.size(); }

TwoSides row_times(const ProfileTimes& base, const ProfileTimes& other, bool paired,
                   const std::string& name) {
    const TimedRow* const a = find_row(base, name);
    const TimedRow* const b = find_row(other, name);
    if (a != nullptr && b != nullptr) return {a->samples_ms, b->samples_ms, paired};
    std::vector<std::string> names;
    for (const TimedRow& row : base.rows) {
        if (find_row(other, name_of(row)) != nullptr) names.push_back(name_of(row));
    }
    throw Error(ExitCode::usage,
                fmt::format("--fail-if '{}': no row of both profiles{}; there are {}", name,
                            did_you_mean(name, std::vector<std::string_view>(names.begin(), names.end())),
                            fmt::join(names, ", ")));
}

}  // namespace

ProfileComparison compare_profiles(const ProfileTimes& base, const ProfileTimes& other, bool paired) {
    ProfileComparison comparison;
    std::vector<double> p_values;
    std::vector<std::size_t> tested;
    for (const TimedRow& row : base.rows) {
        const TimedRow* const same = find_row(other, name_of(row));
        if (same == nullptr) {
            comparison.unmatched.push_back(name_of(row));
            continue;
        }
        const TwoSides times{row.samples_ms, same->samples_ms, paired};
        const RowComparison& result = comparison.rows.emplace_back(compare_rows(row, times));
        const RowComparison& wall = comparison.rows.front();
        if (result.base_ms < least_tested_share * wall.base_ms &&
            result.other_ms < least_tested_share * wall.other_ms) {
            continue;
        }
        tested.push_back(comparison.rows.size() - 1);
        p_values.push_back(rank_test(times, Alternative::different));
    }
    for (const TimedRow& row : other.rows) {
        if (find_row(base, name_of(row)) == nullptr) comparison.unmatched.push_back(name_of(row));
    }
    const std::vector<double> adjusted = holm_adjusted(p_values);
    for (std::size_t i = 0; i < tested.size(); ++i) {
        RowComparison& row = comparison.rows[tested[i]];
        row.p_value = adjusted[i];
        row.verdict = verdict_of(row);
    }
    comparison.tested = tested.size();
    comparison.too_few_repetitions =
        static_cast<double>(tested.size()) * least_p_value(repetitions(base), repetitions(other), paired) >
        comparison_level;
    return comparison;
}

std::vector<LimitResult> check_limits(const ProfileTimes& base, const ProfileTimes& other, bool paired,
                                      const std::vector<SlowdownLimit>& limits) {
    // One side of least_p_value: limits look for longer times alone.
    const double least = least_p_value(repetitions(base), repetitions(other), paired) / 2;
    if (static_cast<double>(limits.size()) * least > comparison_level) {
        throw Error(ExitCode::usage,
                    fmt::format("--fail-if: {} and {} repetitions are too few to be sure of any slowdown; "
                                "profile with a larger --repeat",
                                repetitions(base), repetitions(other)));
    }
    std::vector<LimitResult> results;
    std::vector<double> p_values;
    for (const SlowdownLimit& limit : limits) {
        const TwoSides times = row_times(base, other, paired, limit.row);
        results.push_back({limit, ratio_of(times), bootstrap_interval(times)});
        p_values.push_back(rank_test(times, Alternative::longer, 1 + limit.percent / 100));
    }
    const std::vector<double> adjusted = holm_adjusted(p_values);
    for (std::size_t i = 0; i < results.size(); ++i) {
        results[i].p_value = adjusted[i];
        results[i].exceeded = adjusted[i] <= comparison_level;
    }
    return results;
}

std::string incomparable(const ProfileEnvironment& base, const ProfileEnvironment& other) {
    std::string text;
    const auto compare = [&](const char* name, const auto& a, const auto& b) {
        if (a != b) text += fmt::format("{}: {}, {}\n", name, a, b);
    };
    const auto crop = [](const ProfileEnvironment& environment) {
        return environment.crop ? fmt::format("{}", fmt::join(*environment.crop, ",")) : "none";
    };
    const auto scene = [](const ProfileEnvironment& environment) {
        return fmt::format("{} ({})", environment.scene, environment.scene_hash);
    };
    if (base.scene_hash != other.scene_hash) compare("scene", scene(base), scene(other));
    compare("camera", base.camera, other.camera);
    compare("width", base.width, other.width);
    compare("height", base.height, other.height);
    compare("crop", crop(base), crop(other));
    compare("depth", base.depth, other.depth);
    compare("samples a pixel", base.spp, other.spp);
    compare("seed", base.seed, other.seed);
    compare("device", base.device, other.device);
    compare("platform", base.platform, other.platform);
    compare("driver", base.driver, other.driver);
    compare("processor", base.cpu, other.cpu);
    compare("threads", base.threads, other.threads);
    return text;
}

}  // namespace sahl
