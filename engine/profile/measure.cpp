#include "engine/profile/measure.h"

#include <algorithm>
#include <random>
#include <utility>

#include "engine/core/error.h"
#include "engine/profile/calibrate.h"
#include "engine/profile/samples.h"
#include "engine/profile/statistics.h"

namespace sahl {
namespace {

constexpr int least_repeat = 7;
constexpr int most_repeat = 100;
constexpr double most_seconds = 10;
constexpr double enough = 0.01;
constexpr std::size_t overhead_pairs = 300;  ///< of a frame that is not recorded and one that is

double seconds(std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; }

double wall_seconds(const TimelineRecord& record) { return seconds(record.end_ns - record.begin_ns); }

bool is_enough(const std::vector<double>& walls, const MeasureOptions& options) {
    const auto count = static_cast<int>(walls.size());
    if (options.repeat) return count >= *options.repeat;
    if (count < least_repeat) return false;
    double sum = 0;
    for (const double wall : walls) sum += wall;
    return count >= most_repeat || sum >= most_seconds || median_uncertainty(walls) <= enough;
}

void check_same_rays(const std::vector<GenerationCounts>& a, const std::vector<GenerationCounts>& b) {
    const bool same = std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.rays == y.rays && x.shadow_rays == y.shadow_rays;
    });
    if (!same) {
        throw Error(
            ExitCode::internal,
            "two frames of one scene traced different rays: the device does not compute the same twice; "
            "'sahl devices --test' tests it");
    }
}

/// What recording adds to frames: of a CPU's in processor time, which other programs hardly change.
class Overhead {
public:
    Overhead(Device& device, Renderer& renderer, const FrameJob& job)
        : device_(device), renderer_(renderer), job_(job), by_processor_(device.info().is_cpu) {}

    bool is_enough() const { return times_.other.size() >= overhead_pairs; }

    void run_unrecorded() {
        measure_clock(device_);  // as before frames that are recorded: it wakes the device
        const std::uint64_t begin = now();
        run_frame(device_, renderer_, job_);
        device_.finish();
        times_.base.push_back(seconds(now() - begin));
    }

    void add(const RecordedFrame& frame) {
        times_.other.push_back(by_processor_ ? seconds(frame.processor_ns) : wall_seconds(frame.timeline));
    }

    void describe(ProfileEnvironment& environment) const {
        const auto percent = [](double ratio) { return 100 * (ratio - 1); };
        const Interval interval = bootstrap_interval(times_);
        environment.overhead_percent = percent(ratio_of(times_));
        environment.overhead_low_percent = percent(interval.low);
        environment.overhead_high_percent = percent(interval.high);
    }

private:
    std::uint64_t now() const { return by_processor_ ? processor_ns() : monotonic_ns(); }

    Device& device_;
    Renderer& renderer_;
    const FrameJob& job_;
    bool by_processor_;
    TwoSides times_{{}, {}, true};
};

}  // namespace

Measurement measure(Device& device, Renderer& renderer, const FrameJob& job, const MeasureOptions& options,
                    const std::function<void()>& between_frames) {
    Measurement measurement;
    const std::size_t compiled_before = count_compilations();
    for (int i = 0; i < options.warm_up; ++i) {
        between_frames();
        run_frame(device, renderer, job);
    }
    std::vector<double> walls;
    Overhead overhead(device, renderer, job);
    std::mt19937 coin;  // NOLINT: always the same draws
    while (!is_enough(walls, options)) {
        const bool in_pair = !overhead.is_enough();
        const bool recorded_first = coin() >> 31U != 0;
        between_frames();
        if (in_pair && !recorded_first) overhead.run_unrecorded();
        RecordedFrame frame = record_frame(device, renderer, job);
        walls.push_back(wall_seconds(frame.timeline));
        measurement.environment.clock_uncertainty_ns = std::max(
            measurement.environment.clock_uncertainty_ns, static_cast<double>(frame.clock.uncertainty_ns));
        if (walls.size() == 1) measurement.generations = frame.statistics.generations;
        check_same_rays(measurement.generations, frame.statistics.generations);
        if (in_pair) {
            overhead.add(frame);
            if (recorded_first) overhead.run_unrecorded();
        }
        measurement.frames.push_back(std::move(frame.timeline));
    }
    measurement.compiles_during_render = count_compilations() - compiled_before;
    overhead.describe(measurement.environment);
    measurement.environment.warm_up = options.warm_up;
    between_frames();
    measurement.visits = renderer.count_visits(job.settings);
    measurement.calibration = calibrate(device);
    return measurement;
}

}  // namespace sahl
