#include "engine/profile/measure.h"

#include <algorithm>
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
constexpr int overhead_pairs = 7;  ///< of a recorded frame and one that is not

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
    std::vector<double> overheads;  // recorded over unrecorded
    while (!is_enough(walls, options)) {
        between_frames();
        RecordedFrame frame = record_frame(device, renderer, job);
        walls.push_back(wall_seconds(frame.timeline));
        measurement.environment.clock_uncertainty_ns = std::max(
            measurement.environment.clock_uncertainty_ns, static_cast<double>(frame.clock.uncertainty_ns));
        if (walls.size() == 1) measurement.generations = frame.statistics.generations;
        check_same_rays(measurement.generations, frame.statistics.generations);
        measurement.frames.push_back(std::move(frame.timeline));
        if (overheads.size() == overhead_pairs) continue;
        between_frames();
        device.finish();
        const std::uint64_t begin = monotonic_ns();
        run_frame(device, renderer, job);
        device.finish();
        overheads.push_back(walls.back() / seconds(monotonic_ns() - begin));
    }
    measurement.compiles_during_render = count_compilations() - compiled_before;
    measurement.environment.overhead_percent = 100 * (median(overheads) - 1);
    measurement.environment.warm_up = options.warm_up;
    between_frames();
    measurement.visits = renderer.count_visits(job.settings);
    measurement.calibration = calibrate(device);
    return measurement;
}

}  // namespace sahl
