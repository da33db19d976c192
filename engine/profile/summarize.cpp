#include "engine/profile/summarize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/profile/measures.h"
#include "engine/profile/samples.h"
#include "engine/profile/statistics.h"

namespace sahl {
namespace {

TimeBreakdown breakdown(const TimelineRecord& record, const TimelineSums& sums) {
    TimeBreakdown time;
    time.wall_ms = in_ms(record.end_ns - record.begin_ns);
    time.device_busy_ms = in_ms(sums.busy_ns);
    time.device_idle_ms = in_ms(sums.idle_ns);
    time.unattributed_ms = in_ms(sums.unattributed_ns);
    for (const auto& [name, step] : sums.steps) time.exposed_ms[name] = in_ms(step.exposed_ns);
    return time;
}

/// The launches' times have to be the device's: an in-order queue runs one after the other.
void check_sum(const TimelineRecord& record, const TimelineSums& sums) {
    std::uint64_t launches = 0;
    for (const LaunchRecord& launch : record.launches) launches += launch.ended_ns - launch.started_ns;
    const double difference = std::abs(in_ms(launches) - in_ms(sums.busy_ns));
    if (difference <= 1e-3 * in_ms(record.end_ns - record.begin_ns)) return;
    throw Error(
        ExitCode::internal,
        fmt::format("the launches of a frame took {:.3f} ms and the device was busy for {:.3f} ms: its "
                    "event times cannot be trusted",
                    in_ms(launches), in_ms(sums.busy_ns)));
}

std::vector<ProfileHostStep> host_steps(ProfilePhase phase, const std::vector<TimelineSums>& frames) {
    std::set<std::string> names;
    for (const TimelineSums& frame : frames) {
        for (const auto& [name, step] : frame.steps) names.insert(name);
    }
    std::vector<ProfileHostStep> steps;
    for (const std::string& name : names) {
        ProfileHostStep step{.name = name, .phase = phase};
        std::vector<double> exposed;
        for (const TimelineSums& frame : frames) {
            const auto found = frame.steps.find(name);
            const HostStepTime time = found == frame.steps.end() ? HostStepTime{} : found->second;
            step.calls = std::max(step.calls, time.calls);
            step.samples_ms.push_back(in_ms(time.total_ns));
            exposed.push_back(in_ms(time.exposed_ns));
        }
        step.ms_total = median(step.samples_ms);
        step.ms_exposed = median(exposed);
        steps.push_back(std::move(step));
    }
    std::stable_sort(steps.begin(), steps.end(),
                     [](const auto& a, const auto& b) { return a.ms_total > b.ms_total; });
    return steps;
}

template <class Value>
double median_of(const std::vector<ProfileRepetition>& repetitions, Value value) {
    std::vector<double> values;
    for (const ProfileRepetition& repetition : repetitions) values.push_back(value(repetition.time));
    return median(values);
}

}  // namespace

Profile summarize(const Measurement& measurement) {
    Profile profile;
    profile.environment = measurement.environment;
    profile.calibration = measurement.calibration;
    profile.compiles_during_render = measurement.compiles_during_render;
    profile.compiles_in_setup = measurement.compiles_in_setup;

    const TimelineSums setup = add_up(measurement.setup);
    profile.setup = breakdown(measurement.setup, setup);
    std::vector<TimelineSums> frames;
    std::vector<double> walls;
    for (const TimelineRecord& frame : measurement.frames) {
        frames.push_back(add_up(frame));
        check_sum(frame, frames.back());
        profile.repetitions.push_back({breakdown(frame, frames.back())});
        walls.push_back(profile.repetitions.back().time.wall_ms);
    }
    const std::vector<bool> outliers = find_outliers(walls);
    for (std::size_t i = 0; i < walls.size(); ++i) profile.repetitions[i].outlier = outliers[i];
    profile.wall_ms = median(walls);
    profile.unattributed_ms =
        median_of(profile.repetitions, [](const TimeBreakdown& time) { return time.unattributed_ms; });

    profile.host_steps = host_steps(ProfilePhase::setup, {setup});
    for (ProfileHostStep& step : host_steps(ProfilePhase::frame, frames)) {
        profile.host_steps.push_back(std::move(step));
    }
    add_rows(profile, measurement);
    return profile;
}

}  // namespace sahl
