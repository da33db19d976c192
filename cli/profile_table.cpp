#include "cli/profile_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace sahl::cli {

namespace {

/// Three digits and a prefix, such as 4.19M; "-" for what is not known.
std::string short_number(std::optional<double> number) {
    if (!number) return "-";
    constexpr std::array prefixes{"", "k", "M", "G", "T", "P"};
    double value = *number;
    std::size_t prefix = 0;
    for (; std::abs(value) >= 999.5 && prefix + 1 < prefixes.size(); ++prefix) value /= 1000;
    const int digits = std::abs(value) < 0.05 && prefix == 0 ? 3
                       : std::abs(value) < 10                ? 2
                       : std::abs(value) < 100               ? 1
                                                             : 0;
    if (prefix == 0 && value == std::floor(value)) return fmt::format("{:.0f}", value);
    return fmt::format("{:.{}f}{}", value, digits, prefixes[prefix]);
}

std::string short_count(std::optional<std::uint64_t> count) {
    return count ? short_number(static_cast<double>(*count)) : "-";
}

std::string percent(std::optional<double> value) { return value ? fmt::format("{:.1f}", *value) : "-"; }

std::string row_name(const ProfileRow& row) {
    if (row.kernel.empty()) return "all";
    return row.variant.empty() ? row.kernel : row.kernel + " " + row.variant;
}

std::string generation_of(const ProfileRow& row) {
    return row.generation ? fmt::format("{}", *row.generation) : "*";
}

constexpr const char* time_line =
    "{:>3} {:<17}{:>6}{:>7}{:>7}{:>7}{:>8}{:>8}{:>7}{:>8}{:>7}{:>7}{:>8}{:>7}{:>7}\n";

std::string time_row(const ProfileRow& row) {
    const ProfileMeasures& m = row.measures;
    return fmt::format(fmt::runtime(time_line), generation_of(row), row_name(row), short_count(m.launches),
                       short_count(m.rays_in), short_count(m.rays_out), percent(m.survival_percent),
                       fmt::format("{:.3f}", m.ms_median), fmt::format("{:.3f}", m.ms_p95),
                       percent(m.wall_percent), short_number(m.mrays_per_s), short_number(m.ns_per_ray),
                       percent(100 * m.active_lanes), short_number(m.queued_to_submit_ms),
                       short_number(m.submit_to_start_ms), short_number(m.gap_ms));
}

constexpr const char* work_line = "{:>3} {:<17}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}{:>10}{:>9}\n";

std::string work_row(const ProfileRow& row) {
    const ProfileMeasures& m = row.measures;
    return fmt::format(fmt::runtime(work_line), generation_of(row), row_name(row),
                       short_number(m.node_visits_per_ray), short_number(m.leaf_visits_per_ray),
                       short_number(m.bytes_per_ray), short_number(m.gb_per_s), percent(m.bandwidth_percent),
                       short_number(m.flop_per_ray), short_number(m.gflop_per_s), percent(m.fma_percent));
}

template <class Row>
std::string all_rows(const Profile& profile, Row row_text) {
    std::string text;
    std::optional<std::uint32_t> generation;
    for (const ProfileRow& row : profile.rows) {
        if (generation && generation != row.generation) text += '\n';
        generation = row.generation;
        text += row_text(row);
    }
    text += "\nall generations\n";
    for (const ProfileRow& row : profile.kernel_totals) text += row_text(row);
    text += "\nall kernels; rays of intersect and their children\n";
    for (const ProfileRow& row : profile.generation_totals) text += row_text(row);
    return text;
}

std::string header(const Profile& profile) {
    const ProfileEnvironment& e = profile.environment;
    std::string text = fmt::format(
        "scene       {}, camera {}, {}x{}{}, depth {}, {} spp\n"
        "device      {}, {} threads ({}, driver {})\n"
        "processor   {}\n"
        "limits      {:.1f} GB/s, {:.0f} GFLOP/s{}\n"
        "compiles    during render: {}, before: {}\n",
        e.scene, e.camera, e.width, e.height, e.crop ? fmt::format(", crop {}", fmt::join(*e.crop, ",")) : "",
        e.depth, e.spp, e.device, e.threads, e.platform, e.driver, e.cpu,
        profile.calibration.bandwidth_gb_per_s, profile.calibration.fma_gflop_per_s,
        profile.calibration.cached ? ", measured in an earlier run" : "", profile.compiles_during_render,
        profile.compiles_in_setup);
    return text;
}

/// "step 1.234" for the largest exposed steps.
std::string exposed_text(const TimeBreakdown& time) {
    std::vector<std::pair<double, std::string>> steps;
    for (const auto& [name, ms] : time.exposed_ms) steps.emplace_back(ms, name);
    std::sort(steps.rbegin(), steps.rend());
    std::string text;
    for (const auto& [ms, name] : steps) {
        const std::string step = fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", name, ms);
        if (text.size() + step.size() > 100) return text + ", ...";
        text += step;
    }
    return text;
}

std::string sums(const Profile& profile) {
    const std::vector<ProfileRepetition>& all = profile.repetitions;
    const auto middle = std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.time.wall_ms - profile.wall_ms) < std::abs(b.time.wall_ms - profile.wall_ms);
    });
    const TimeBreakdown& time = middle->time;
    std::string text = fmt::format(
        "frames      {} after {} of warm-up; median {:.3f} ms; recording adds {:.1f} % ({:.1f} to {:.1f}); "
        "clocks to {:.0f} us\n"
        "a frame     wall {:.3f} ms = device busy {:.3f} + idle {:.3f} (the repetition nearest the median)\n"
        "  idle      {}\n"
        "  rest      unattributed {:.3f} ms, {:.2f} % of wall\n",
        all.size(), profile.environment.warm_up, profile.wall_ms, profile.environment.overhead_percent,
        profile.environment.overhead_low_percent, profile.environment.overhead_high_percent,
        profile.environment.clock_uncertainty_ns * 1e-3, time.wall_ms, time.device_busy_ms,
        time.device_idle_ms, exposed_text(time), time.unattributed_ms,
        time.wall_ms > 0 ? 100 * time.unattributed_ms / time.wall_ms : 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].outlier) continue;
        text += fmt::format("  outlier   repetition {}: {:.3f} ms, {:.2f} times the median\n", i,
                            all[i].time.wall_ms, all[i].time.wall_ms / profile.wall_ms);
    }
    return text;
}

std::string host_steps(const Profile& profile) {
    std::string text =
        fmt::format("{:<18}{:<7}{:>7}{:>12}{:>12}\n", "host step", "phase", "calls", "ms", "exposed");
    for (const ProfileHostStep& step : profile.host_steps) {
        text += fmt::format("{:<18}{:<7}{:>7}{:>12.3f}{:>12.3f}\n", step.name,
                            step.phase == ProfilePhase::setup ? "setup" : "frame", step.calls, step.ms_total,
                            step.ms_exposed);
    }
    return text;
}

}  // namespace

std::string profile_text(const Profile& profile) {
    std::string text = header(profile) + sums(profile) + '\n';
    text += fmt::format(fmt::runtime(time_line), "gen", "kernel", "calls", "rays", "out", "surv%", "ms",
                        "p95", "wall%", "Mrays/s", "ns/ray", "lanes%", "queued", "submit", "gap");
    text += all_rows(profile, time_row) + '\n';
    text += fmt::format(fmt::runtime(work_line), "gen", "kernel", "nodes", "leaves", "B/ray", "GB/s",
                        "of max%", "FLOP/ray", "GFLOP/s", "of max%");
    text += all_rows(profile, work_row) + '\n';
    return text + host_steps(profile);
}

}  // namespace sahl::cli
