#include "cli/profile_diff_report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/standard_output.h"
#include "engine/core/log.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr double most_percent = 1e6;

const char* word_for(SpeedVerdict verdict) {
    switch (verdict) {
        case SpeedVerdict::faster:
            return "faster";
        case SpeedVerdict::slower:
            return "slower";
        default:
            return "no difference";
    }
}

/// "+4.8 %" for 1.048.
std::string percent(double ratio) { return fmt::format("{:+.1f} %", 100 * (ratio - 1)); }

std::string interval_text(const Interval& interval) {
    return fmt::format("{:+.1f} .. {}", 100 * (interval.low - 1), percent(interval.high));
}

std::string p_text(double p) { return p < 0.0001 ? "< 0.0001" : fmt::format("{:.4f}", p); }

std::string side_line(const char* side, const std::string& name, const ProfileEnvironment& environment,
                      const std::string& frames) {
    return fmt::format("{:<6} {}  (sahl {}, kernels {:.8}, tree {}, {})\n", side, name, environment.sahl,
                       environment.kernel_hash, environment.build_quality, frames);
}

/// "20 repetitions", or of what ran in turn "300 frames in 20 blocks".
std::string frames_text(int pairs, std::size_t repetitions) {
    return pairs > 0 ? fmt::format("{} frames in {} blocks", pairs, repetitions)
                     : fmt::format("{} repetitions", repetitions);
}

std::string row_line(const RowComparison& row) {
    const std::string name = row.row.generation ? "  " + name_of(row.row) : name_of(row.row);
    return fmt::format("{:<20} {:>10.3f} {:>10.3f} {:>9}  {:>19} {:>9}  {}\n", name, row.base_ms,
                       row.other_ms, percent(row.ratio), interval_text(row.interval), p_text(*row.p_value),
                       word_for(row.verdict));
}

std::string limit_line(const LimitResult& result) {
    return fmt::format("limit {} {:+g} %: {}, 95 % interval {}, p {}: {}\n", result.limit.row,
                       result.limit.percent, percent(result.ratio), interval_text(result.interval),
                       p_text(result.p_value), result.exceeded ? "exceeded" : "kept");
}

std::string table(const ProfileDiff& diff) {
    std::string text =
        side_line("base", diff.base_name, diff.base, frames_text(diff.pairs, diff.base_repetitions)) +
        side_line("other", diff.other_name, diff.other, frames_text(diff.pairs, diff.other_repetitions)) +
        "\n" +
        fmt::format("{:<20} {:>10} {:>10} {:>9}  {:>19} {:>9}  {}\n", "kernel/generation", "base ms",
                    "other ms", "change", "95 % interval", "p", "verdict");
    for (const RowComparison& row : diff.comparison.rows) {
        if (row.p_value) text += row_line(row);
    }
    if (const std::size_t small = diff.comparison.rows.size() - diff.comparison.tested; small > 0) {
        text += fmt::format("{} more rows take less than {:g} % of a frame and are not tested\n", small,
                            100 * least_tested_share);
    }
    if (!diff.comparison.unmatched.empty()) {
        text += fmt::format("on one side only: {}\n", fmt::join(diff.comparison.unmatched, ", "));
    }
    text += "\n";
    for (const LimitResult& limit : diff.limits) text += limit_line(limit);
    return text;
}

/// Infinities and what is no number become null.
Json row_json(const RowComparison& row) {
    Json json{{"kernel", row.row.kernel}, {"generation", nullptr}};
    if (row.row.generation) json["generation"] = *row.row.generation;
    json.update({{"base_ms", row.base_ms},
                 {"other_ms", row.other_ms},
                 {"ratio", row.ratio},
                 {"ratio_low", row.interval.low},
                 {"ratio_high", row.interval.high},
                 {"p_value", nullptr},
                 {"verdict", row.p_value ? word_for(row.verdict) : "not tested"}});
    if (row.p_value) json["p_value"] = *row.p_value;
    return json;
}

Json side_json(const std::string& name, const ProfileEnvironment& environment, std::size_t repetitions) {
    return {{"name", name},
            {"sahl", environment.sahl},
            {"kernel_hash", environment.kernel_hash},
            {"build_quality", environment.build_quality},
            {"repetitions", repetitions}};
}

bool passed(const ProfileDiff& diff) {
    return std::none_of(diff.limits.begin(), diff.limits.end(),
                        [](const LimitResult& limit) { return limit.exceeded; });
}

Json event(const ProfileDiff& diff) {
    Json rows = Json::array();
    for (const RowComparison& row : diff.comparison.rows) rows.push_back(row_json(row));
    Json limits = Json::array();
    for (const LimitResult& limit : diff.limits) {
        limits.push_back({{"row", limit.limit.row},
                          {"limit_percent", limit.limit.percent},
                          {"ratio", limit.ratio},
                          {"ratio_low", limit.interval.low},
                          {"ratio_high", limit.interval.high},
                          {"p_value", limit.p_value},
                          {"exceeded", limit.exceeded}});
    }
    return {{"event", "profile_diff"},
            {"base", side_json(diff.base_name, diff.base, diff.base_repetitions)},
            {"other", side_json(diff.other_name, diff.other, diff.other_repetitions)},
            {"interleaved", diff.pairs > 0},
            {"pairs", diff.pairs},
            {"level", comparison_level},
            {"rows", rows},
            {"unmatched", diff.comparison.unmatched},
            {"limits", limits},
            {"passed", passed(diff)}};
}

/// "intersect:+3%" or "intersect/2:+3%".
SlowdownLimit read_limit(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == 0 || colon == std::string::npos || !text.ends_with('%') ||
        text.substr(colon + 1, 1) != "+") {
        refuse("--fail-if", text, "ROW:+PERCENT%, such as intersect:+3%, intersect/2:+5% or wall:+1%,");
    }
    const std::string number = text.substr(colon + 2, text.size() - colon - 3);
    return {text.substr(0, colon), read_number("--fail-if", number, 0, most_percent)};
}

}  // namespace

ProfileDiff diff_profiles(const std::string& base_name, const ProfileTimes& base,
                          const std::string& other_name, const ProfileTimes& other, int pairs,
                          const std::vector<SlowdownLimit>& limits) {
    return {base_name,
            other_name,
            base.environment,
            other.environment,
            base.rows.front().samples_ms.size(),
            other.rows.front().samples_ms.size(),
            pairs,
            compare_profiles(base, other, pairs > 0),
            check_limits(base, other, pairs > 0, limits)};
}

void add_fail_if_option(CLI::App& command, std::vector<SlowdownLimit>& limits) {
    add_values(
        command, "--fail-if", "ROW:+P%",
        [&limits](const std::string& text) { limits.push_back(read_limit(text)); },
        "exit status 9 where a row is more than P % slower, by more than chance; may be given several times");
}

ExitCode report(const ProfileDiff& diff, const CommonOptions& common) {
    if (common.json) {
        print_event(event(diff));
    } else if (!common.quiet) {
        print(table(diff));
    }
    if (diff.comparison.too_few_repetitions) {
        log_warning(fmt::format(
            "{} and {} {} are too few to tell {} rows apart: 'no difference' says nothing here; profile "
            "with a larger --repeat",
            diff.base_repetitions, diff.other_repetitions, diff.pairs > 0 ? "blocks" : "repetitions",
            diff.comparison.tested));
    }
    return passed(diff) ? ExitCode::ok : ExitCode::performance;
}

}  // namespace sahl::cli
