#include "cli/batch_listing.h"

#include <map>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/batch_scene.h"
#include "cli/driver_failure.h"
#include "cli/memory_report.h"
#include "cli/render_report.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

/// What is asked for, in a few words.
std::string settings_text(const BatchJob& job) {
    const ImageSettings& settings = job.settings;
    std::string text = job.scene.filename().string();
    if (!job.camera.empty()) text += ", " + job.camera;
    for (const auto& [name, value] : job.parameters) text += fmt::format(", {}={}", name, value);
    if (settings.size) text += fmt::format(", {}x{}", settings.size->width, settings.size->height);
    if (settings.depth) text += fmt::format(", depth {}", *settings.depth);
    return text + fmt::format(", {} spp", settings.spp.value_or(1));
}

Json job_event(std::size_t index, const BatchJob& job, const JobOutcome& outcome) {
    Json event{{"event", "job"},
               {"job", index},
               {"paths", paths_of(job)},
               {"scene", job.scene.string()},
               {"finished", outcome.state == JobState::finished},
               {"reason", outcome.reason}};
    if (!job.camera.empty()) event["camera"] = job.camera;
    if (job.frame) event["frame"] = *job.frame;
    event["parameters"] = Json::object();
    for (const auto& [name, value] : job.parameters) event["parameters"][name] = value;
    if (job.settings.size) event["size"] = {job.settings.size->width, job.settings.size->height};
    if (job.settings.depth) event["depth"] = *job.settings.depth;
    event["spp"] = job.settings.spp.value_or(1);
    return event;
}

std::string job_line(const BatchJob& job, const JobOutcome& outcome) {
    return fmt::format("{}  ({})  {}\n", fmt::join(paths_of(job), ", "), settings_text(job),
                       outcome.state == JobState::finished ? "finished" : outcome.reason);
}

void print_jobs(const BatchSetup& setup, const std::vector<JobOutcome>& outcomes, bool json,
                bool only_unfinished) {
    std::string text;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (only_unfinished && outcomes[i].state == JobState::finished) continue;
        if (json) {
            constexpr auto replace = Json::error_handler_t::replace;
            text += job_event(i, setup.jobs[i], outcomes[i]).dump(-1, ' ', false, replace) + "\n";
        } else {
            text += job_line(setup.jobs[i], outcomes[i]);
        }
    }
    print(text);
}

struct Jobs {
    const BatchJob* first = nullptr;
    std::size_t count = 0;
};

/// Seconds for a sample, of some thousand of the job.
double seconds_per_sample(Device& device, BatchScene& scene, const PreparedJob& prepared) {
    constexpr int side = 64;
    RenderSettings settings = prepared.settings;
    settings.resolution = {std::min(settings.resolution.width, side),
                           std::min(settings.resolution.height, side)};
    settings.spp = std::min(settings.spp, 4);
    double seconds = 0;
    for (int i = 0; i < 2; ++i) {  // the first run compiles the kernels
        Film film(device.memory(), settings.resolution.width, settings.resolution.height);
        seconds = scene.renderer().render(settings, film).seconds;
    }
    return seconds / static_cast<double>(pixel_count(settings.resolution)) / settings.spp;
}

}  // namespace

ExitCode print_batch_plan(BatchSetup& setup, const std::vector<JobOutcome>& outcomes, bool json) {
    print_jobs(setup, outcomes, json, false);
    std::map<std::filesystem::path, Jobs> scenes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (outcomes[i].state == JobState::finished) continue;
        Jobs& jobs = scenes[setup.jobs[i].scene];
        if (jobs.first == nullptr) jobs.first = &setup.jobs[i];
        ++jobs.count;
    }
    if (scenes.empty()) return ExitCode::ok;
    Device device(setup.worker.device);
    take_driver_failures();
    device.memory().set_limit(setup.worker.max_memory.value_or(physical_memory_bytes()));
    BatchScene scene(device);
    ExitCode code = ExitCode::ok;
    double all_seconds = 0;
    for (const auto& [path, jobs] : scenes) {
        try {
            const PreparedJob prepared = scene.prepare(*jobs.first, setup.content_of(*jobs.first));
            const auto samples = static_cast<double>(pixel_count(prepared.settings.resolution)) *
                                 prepared.settings.spp * static_cast<double>(jobs.count);
            const double seconds = samples * seconds_per_sample(device, scene, prepared);
            all_seconds += seconds;
            if (json) {
                Json memory;
                for (const auto& [name, bytes] : memory_parts(prepared.plan)) memory[name] = bytes;
                print_event({{"event", "scene"},
                             {"scene", path.string()},
                             {"images", jobs.count},
                             {"seconds", seconds},
                             {"memory", memory}});
            } else {
                print(fmt::format(
                    "{}: {} images, about {}; memory {} (limit {}), and {} of the OpenCL driver\n",
                    path.string(), jobs.count, clock_time(seconds), human_size(prepared.plan.total()),
                    human_size(device.memory().limit()), human_size(runtime_base_bytes)));
            }
        } catch (const Error& error) {
            log_error(error.what());
            if (code == ExitCode::ok) code = error.code();
        }
    }
    if (json) {
        print_event({{"event", "estimate"}, {"seconds", all_seconds}});
    } else {
        print(fmt::format("about {} in all\n", clock_time(all_seconds)));
    }
    return code;
}

ExitCode print_batch_check(const BatchSetup& setup, const std::vector<JobOutcome>& outcomes, bool json) {
    print_jobs(setup, outcomes, json, true);
    for (const JobOutcome& outcome : outcomes)
        if (outcome.state != JobState::finished) return ExitCode::resume_mismatch;
    return ExitCode::ok;
}

}  // namespace sahl::cli
