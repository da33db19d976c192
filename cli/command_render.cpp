// `sahl render`: a scene to one image, or to one image for each depth.
#include <unistd.h>

#include <iostream>
#include <memory>
#include <numeric>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output_name.h"
#include "cli/standard_output.h"
#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/film/image_io.h"

namespace sahl::cli {

namespace {

constexpr double most_stops = 100;
constexpr int most_samples = 16384;  // more could overflow the film's fixed point

struct RenderOptions {
    std::string scene;
    LoadOptions loading;
    std::optional<std::string> output;
    std::optional<Resolution> size;
    std::optional<std::vector<int>> depths;
    std::optional<Crop> crop;
    int spp = 1;
    std::uint64_t seed = 0;
    OutputSettings encoding;
};

/// One finished image.
struct Rendered {
    std::filesystem::path path;
    RenderSettings settings;
    Resolution size;  ///< of the file: the crop's
    RenderStatistics statistics;
    std::uint64_t non_finite = 0;
    std::uint64_t clamped = 0;
};

GenerationCounts total(const RenderStatistics& statistics) {
    return std::accumulate(
        statistics.generations.begin(), statistics.generations.end(), GenerationCounts{},
        [](const GenerationCounts& sum, const GenerationCounts& generation) {
            return GenerationCounts{sum.rays + generation.rays, sum.shadow_rays + generation.shadow_rays};
        });
}

void check_crop(const Crop& crop, const Resolution& resolution) {
    if (crop.x1 <= resolution.width && crop.y1 <= resolution.height) return;
    throw Error(ExitCode::usage,
                fmt::format("--crop {},{},{},{} reaches outside the image, which is {}x{}", crop.x0, crop.y0,
                            crop.x1, crop.y1, resolution.width, resolution.height));
}

ProgressStyle progress_style(const CommonOptions& common) {
    if (common.quiet) return ProgressStyle::none;
    return isatty(STDERR_FILENO) != 0 ? ProgressStyle::bar : ProgressStyle::lines;
}

void print_start(const RenderOptions& options, const RenderSettings& settings, const std::vector<int>& depths,
                 const DeviceInfo& device, const BvhStatistics& bvh) {
    nlohmann::ordered_json event{{"event", "start"},
                                 {"version", SAHL_VERSION},
                                 {"scene", options.scene},
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
    const GenerationCounts rays = total(image.statistics);
    print_event({{"event", "image"},
                 {"path", image.path.string()},
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
    fmt::print(stderr, "wrote {}  {}x{}, depth {}, {} spp, {:.2f} s, {}rays/s\n", image.path.string(),
               image.size.width, image.size.height, image.settings.depth, image.settings.spp, seconds,
               with_prefix(rate));
}

void warn_of_lost_light(const Rendered& image) {
    if (image.non_finite > 0) {
        log_warning(fmt::format("{}: {} contributions were no finite numbers and count as black",
                                image.path.string(), image.non_finite));
    }
    if (image.clamped > 0) {
        log_warning(fmt::format("{}: {} contributions were brighter than {} and were cut to that",
                                image.path.string(), image.clamped, Film::max_contribution));
    }
}

std::vector<std::pair<std::string, std::string>> metadata(const Rendered& image, const RenderOptions& options,
                                                          const DeviceInfo& device) {
    return {{"Software", "Sahl " SAHL_VERSION},
            {"Sahl:Scene", std::filesystem::path(options.scene).filename().string()},
            {"Sahl:Depth", std::to_string(image.settings.depth)},
            {"Sahl:SamplesPerPixel", std::to_string(image.settings.spp)},
            {"Sahl:Seed", std::to_string(image.settings.seed)},
            {"Sahl:Device", device.name},
            {"Sahl:Driver", device.driver},
            {"Sahl:RenderSeconds", fmt::format("{:.3f}", image.statistics.seconds)},
            {"Sahl:NonFinite", std::to_string(image.non_finite)},
            {"Sahl:Clamped", std::to_string(image.clamped)}};
}

Rendered render_image(Renderer& renderer, Device& device, const RenderSettings& settings,
                      const std::filesystem::path& path, const RenderOptions& options,
                      const CommonOptions& common) {
    Rendered result{path, settings, settings.resolution, {}, 0, 0};
    if (const auto& crop = settings.crop) result.size = {crop->x1 - crop->x0, crop->y1 - crop->y0};
    Film film(device.memory(), result.size.width, result.size.height);
    {
        Progress progress(std::cerr, progress_style(common), fmt::format("depth {}", settings.depth),
                          "samples");
        result.statistics = renderer.render(
            settings, film,
            [&progress](std::uint64_t done, std::uint64_t all) { progress.update(done, all); });
    }
    result.non_finite = film.non_finite_count();
    result.clamped = film.clamped_count();
    OutputSettings encoding = options.encoding;
    encoding.metadata = metadata(result, options, device.info());
    write_image(path, film.resolve(settings.spp), encoding);
    return result;
}

ExitCode render(const RenderOptions& options, const CommonOptions& common) {
    const Scene scene = load_scene(options.scene, options.loading);
    RenderSettings settings;
    settings.resolution = options.size.value_or(scene.resolution);
    settings.spp = options.spp;
    settings.seed = options.seed;
    settings.crop = options.crop;
    if (options.crop) check_crop(*options.crop, settings.resolution);
    const std::vector<int> depths = options.depths.value_or(std::vector<int>{scene.depth});
    const std::vector<std::filesystem::path> paths = output_names(options.output, options.scene, depths);
    for (const std::filesystem::path& path : paths) check_output(path, options.encoding);

    Device device(common.device);
    log_debug(fmt::format("device {} ({}), driver {}", device.info().name, device.info().platform,
                          device.info().driver));
    Renderer renderer(device, scene);
    const BvhStatistics& bvh = renderer.bvh_statistics();
    log_debug(fmt::format("{} primitives; tree of {} nodes, {} levels, built in {:.2f} s", bvh.primitives,
                          bvh.nodes, bvh.depth, bvh.build_seconds));
    if (common.json) print_start(options, settings, depths, device.info(), bvh);

    for (std::size_t i = 0; i < depths.size(); ++i) {
        settings.depth = depths[i];
        const Rendered image = render_image(renderer, device, settings, paths[i], options, common);
        warn_of_lost_light(image);
        if (!common.quiet) say_image(image);
        if (common.json) print_image(image);
    }
    return ExitCode::ok;
}

void add_image_options(CLI::App& command, RenderOptions& options) {
    add_value(
        command, "--size", "WxH",
        [&options](const std::string& text) { options.size = read_size("--size", text); },
        "pixels (default: the scene's)");
    add_value(
        command, "--depth", "N[,N...]",
        [&options](const std::string& text) { options.depths = read_depths("--depth", text); },
        "generations of rays after the camera's, 0 to 64 (default: the scene's)");
    add_value(
        command, "--spp", "N",
        [&options](const std::string& text) {
            options.spp = read_whole<int>("--spp", text, 1, most_samples);
        },
        "samples a pixel, 1 to 16384 (default: 1, the pixel's centre)");
    add_value(
        command, "--seed", "N",
        [&options](const std::string& text) {
            options.seed =
                read_whole<std::uint64_t>("--seed", text, 0, std::numeric_limits<std::uint64_t>::max());
        },
        "of the random numbers (default: 0)");
    add_value(
        command, "--crop", "X0,Y0,X1,Y1",
        [&options](const std::string& text) { options.crop = read_crop("--crop", text); },
        "only these pixels; X1 and Y1 are just outside");
}

void add_encoding_options(CLI::App& command, OutputSettings& encoding) {
    add_choice<Transfer>(command, "--transfer", "CURVE", encoding.transfer,
                         {{"srgb", Transfer::srgb}, {"linear", Transfer::linear}},
                         "(default: srgb for 8 and 16 bits, linear for floats)");
    add_choice<Rounding>(command, "--rounding", "RULE", encoding.rounding,
                         {{"round", Rounding::round}, {"floor", Rounding::floor}},
                         "for 8 and 16 bits (default: round)");
    add_value(
        command, "--exposure", "STOPS",
        [&encoding](const std::string& text) {
            encoding.exposure = static_cast<float>(read_number("--exposure", text, -most_stops, most_stops));
        },
        "makes the image 2^STOPS as bright (default: 0)");
    add_choice<PixelType>(command, "--pixel-type", "TYPE", encoding.pixel_type,
                          {{"half", PixelType::half},
                           {"float", PixelType::float32},
                           {"uint8", PixelType::uint8},
                           {"uint16", PixelType::uint16}},
                          "(default: the format's)");
}

}  // namespace

Command add_render_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "renders a scene");
    command->add_option("SCENE", options->scene, "scene file: .json, .nff or .test")
        ->required()
        ->type_name("FILE");
    add_value(
        *command, "-o,--output", "FILE",
        [&options = *options](const std::string& text) { options.output = text; },
        "image; {depth} stands for the depth (default: the scene's name, .png, here)");
    add_scene_options(*command, options->loading);
    add_image_options(*command, *options);
    add_encoding_options(*command, options->encoding);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "Examples:\n"
        "  sahl render balls.nff\n"
        "  sahl render balls.nff -o balls.exr --size 1920x1080 --spp 16\n"
        "  sahl render balls.nff --depth 0,1,2,3,4,7 -o 'd{depth}.png'\n"
        "  sahl render scene.test -o exact.png --transfer linear --rounding floor");
    return {command, [options, &common] { return render(*options, common); }};
}

}  // namespace sahl::cli
