#include "cli/render_report.h"

#include <numeric>

#include <nlohmann/json.hpp>

#include "cli/memory_report.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> paths_of(const std::vector<Output>& outputs) {
    std::vector<std::string> paths;
    for (const Output& output : outputs) paths.push_back(output.path.string());
    return paths;
}

/// What is to be rendered on what.
Json job_event(const char* name, const RenderOptions& options, const Job& job, const DeviceInfo& device) {
    const RenderSettings& settings = job.settings;
    Json event{{"event", name},
               {"version", SAHL_VERSION},
               {"scene", options.scene},
               {"camera", job.camera},
               {"width", settings.resolution.width},
               {"height", settings.resolution.height},
               {"depths", job.depths},
               {"spp", settings.spp},
               {"seed", settings.seed},
               {"device", device.name},
               {"driver", device.driver}};
    if (const auto& crop = settings.crop) event["crop"] = {crop->x0, crop->y0, crop->x1, crop->y1};
    if (const auto& samples = settings.samples) event["samples"] = {samples->begin, samples->end};
    return event;
}

}  // namespace

GenerationCounts total_rays(const RenderStatistics& statistics) {
    return std::accumulate(
        statistics.generations.begin(), statistics.generations.end(), GenerationCounts{},
        [](const GenerationCounts& sum, const GenerationCounts& generation) {
            return GenerationCounts{sum.rays + generation.rays, sum.shadow_rays + generation.shadow_rays};
        });
}

bool is_partial(const Rendered& image) { return image.statistics.finished_pixels < pixel_count(image.size); }

void print_start(const RenderOptions& options, const Job& job, const DeviceInfo& device,
                 const BvhStatistics& bvh) {
    Json event = job_event("start", options, job, device);
    event["primitives"] = bvh.primitives;
    event["bvh_seconds"] = bvh.build_seconds;
    print_event(event);
}

void print_dry_run(const RenderOptions& options, const Job& job, const DeviceInfo& device,
                   const MemoryPlan& plan, std::uint64_t limit, bool json) {
    const Resolution& size = job.settings.resolution;
    if (json) {
        Json event = job_event("plan", options, job, device);
        Json outputs = Json::array();
        for (const std::vector<Output>& files : job.outputs) outputs.push_back(paths_of(files));
        event["outputs"] = outputs;
        Json memory;
        for (const auto& [name, bytes] : memory_parts(plan)) memory[name] = bytes;
        memory["limit"] = limit;
        memory["runtime_base"] = runtime_base_bytes;
        event["memory"] = memory;
        event["ray_budget"] = plan.ray_budget;
        print_event(event);
        return;
    }
    std::string text = fmt::format("{:<18}{}\n{:<18}{}, {}x{}, {} samples a pixel\n", "scene", options.scene,
                                   "image", job.camera, size.width, size.height, job.settings.spp);
    for (std::size_t i = 0; i < job.depths.size(); ++i) {
        text += fmt::format("{:<18}{}\n", fmt::format("depth {}", job.depths[i]),
                            fmt::join(paths_of(job.outputs[i]), ", "));
    }
    text += fmt::format("{:<18}{}\n{:<18}batches of {} rays; limit {}\n{}", "device", device.name, "memory",
                        plan.ray_budget, human_size(limit), memory_lines(plan));
    text += fmt::format("  {:<16}{:>12}  the OpenCL driver and libraries, beside the total\n", "base",
                        human_size(runtime_base_bytes));
    print(text);
}

void print_image(const Rendered& image) {
    Json generations = Json::array();
    for (const GenerationCounts& generation : image.statistics.generations) {
        generations.push_back({{"rays", generation.rays}, {"shadow_rays", generation.shadow_rays}});
    }
    const std::vector<std::string> paths = paths_of(image.outputs);
    const GenerationCounts rays = total_rays(image.statistics);
    print_event({{"event", "image"},
                 {"path", paths.front()},
                 {"paths", paths},
                 {"width", image.size.width},
                 {"height", image.size.height},
                 {"depth", image.settings.depth},
                 {"spp", image.settings.spp},
                 {"seconds", image.statistics.seconds},
                 {"rays", rays.rays},
                 {"shadow_rays", rays.shadow_rays},
                 {"generations", generations},
                 {"non_finite", image.non_finite},
                 {"clamped", image.clamped}});
}

void say_image(const Rendered& image) {
    const GenerationCounts rays = total_rays(image.statistics);
    const double seconds = image.statistics.seconds;
    const double rate = seconds > 0 ? static_cast<double>(rays.rays + rays.shadow_rays) / seconds : 0;
    print_message(fmt::format("wrote {}  {}x{}, depth {}, {} spp, {:.2f} s, {}rays/s\n",
                              fmt::join(paths_of(image.outputs), ", "), image.size.width, image.size.height,
                              image.settings.depth, image.settings.spp, seconds, with_prefix(rate)));
}

void warn_of_lost_light(const Rendered& image) {
    if (image.non_finite > 0) {
        log_warning(fmt::format("{}: {} contributions were no finite numbers and count as black",
                                fmt::join(paths_of(image.outputs), ", "), image.non_finite));
    }
    if (image.clamped > 0) {
        log_warning(fmt::format("{}: {} contributions were brighter than {} and were cut to that",
                                fmt::join(paths_of(image.outputs), ", "), image.clamped,
                                Film::max_contribution));
    }
}

std::vector<std::pair<std::string, std::string>> metadata(const Rendered& image, const RenderOptions& options,
                                                          const DeviceInfo& device) {
    std::vector<std::pair<std::string, std::string>> entries{
        {"Software", "Sahl " SAHL_VERSION},
        {"Sahl:Scene", std::filesystem::path(options.scene).filename().string()},
        {"Sahl:Camera", image.camera},
        {"Sahl:Depth", std::to_string(image.settings.depth)},
        {"Sahl:SamplesPerPixel", std::to_string(image.settings.spp)},
        {"Sahl:Seed", std::to_string(image.settings.seed)},
        {"Sahl:Device", device.name},
        {"Sahl:Driver", device.driver},
        {"Sahl:RenderSeconds", fmt::format("{:.3f}", image.statistics.seconds)},
        {"Sahl:NonFinite", std::to_string(image.non_finite)},
        {"Sahl:Clamped", std::to_string(image.clamped)}};
    if (is_partial(image)) {
        entries.emplace_back("Sahl:Partial", fmt::format("{} of {} pixels", image.statistics.finished_pixels,
                                                         pixel_count(image.size)));
    }
    if (const auto& samples = image.settings.samples) {
        entries.emplace_back("Sahl:Samples", fmt::format("{}..{}", samples->begin, samples->end));
    }
    if (options.encoding.exposure != 0) {
        entries.emplace_back("Sahl:Exposure", fmt::format("{}", options.encoding.exposure));
    }
    std::string parameters;
    for (const auto& [name, value] : options.loading.parameters) {
        parameters += fmt::format("{}{}={}", parameters.empty() ? "" : " ", name, value);
    }
    if (!parameters.empty()) entries.emplace_back("Sahl:Parameters", parameters);
    return entries;
}

}  // namespace sahl::cli
