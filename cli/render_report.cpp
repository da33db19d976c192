#include "cli/render_report.h"

#include <numeric>

#include <nlohmann/json.hpp>

#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

std::string paths_of(const Rendered& image) {
    std::string text;
    for (const Output& output : image.outputs) text += (text.empty() ? "" : ", ") + output.path.string();
    return text;
}

GenerationCounts total(const RenderStatistics& statistics) {
    return std::accumulate(
        statistics.generations.begin(), statistics.generations.end(), GenerationCounts{},
        [](const GenerationCounts& sum, const GenerationCounts& generation) {
            return GenerationCounts{sum.rays + generation.rays, sum.shadow_rays + generation.shadow_rays};
        });
}

}  // namespace

bool is_partial(const Rendered& image) { return image.statistics.finished_pixels < pixel_count(image.size); }

void print_start(const RenderOptions& options, const RenderSettings& settings, const std::vector<int>& depths,
                 const std::string& camera, const DeviceInfo& device, const BvhStatistics& bvh) {
    nlohmann::ordered_json event{{"event", "start"},
                                 {"version", SAHL_VERSION},
                                 {"scene", options.scene},
                                 {"camera", camera},
                                 {"width", settings.resolution.width},
                                 {"height", settings.resolution.height},
                                 {"depths", depths},
                                 {"spp", settings.spp},
                                 {"seed", settings.seed},
                                 {"device", device.name},
                                 {"driver", device.driver},
                                 {"primitives", bvh.primitives},
                                 {"bvh_seconds", bvh.build_seconds}};
    if (const auto& crop = settings.crop) event["crop"] = {crop->x0, crop->y0, crop->x1, crop->y1};
    print_event(event);
}

void print_image(const Rendered& image) {
    nlohmann::ordered_json generations = nlohmann::ordered_json::array();
    for (const GenerationCounts& generation : image.statistics.generations) {
        generations.push_back({{"rays", generation.rays}, {"shadow_rays", generation.shadow_rays}});
    }
    nlohmann::ordered_json paths = nlohmann::ordered_json::array();
    for (const Output& output : image.outputs) paths.push_back(output.path.string());
    const GenerationCounts rays = total(image.statistics);
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
    const GenerationCounts rays = total(image.statistics);
    const double seconds = image.statistics.seconds;
    const double rate = seconds > 0 ? static_cast<double>(rays.rays + rays.shadow_rays) / seconds : 0;
    fmt::print(stderr, "wrote {}  {}x{}, depth {}, {} spp, {:.2f} s, {}rays/s\n", paths_of(image),
               image.size.width, image.size.height, image.settings.depth, image.settings.spp, seconds,
               with_prefix(rate));
}

void warn_of_lost_light(const Rendered& image) {
    if (image.non_finite > 0) {
        log_warning(fmt::format("{}: {} contributions were no finite numbers and count as black",
                                paths_of(image), image.non_finite));
    }
    if (image.clamped > 0) {
        log_warning(fmt::format("{}: {} contributions were brighter than {} and were cut to that",
                                paths_of(image), image.clamped, Film::max_contribution));
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
