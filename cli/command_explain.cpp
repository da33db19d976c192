// `sahl explain`: where the light of one pixel comes from.
#include <memory>

#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/explain_report.h"
#include "cli/options.h"
#include "cli/render_settings.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

struct Pixel {
    int x = 0, y = 0;
};

struct ExplainOptions {
    RenderOptions render;  ///< of it the scene and the image
    Pixel pixel;
};

Pixel read_pixel(std::string_view option, std::string_view text) {
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != 2) refuse(option, text, "X,Y, pixels from the top left,");
    const auto coordinate = [option](std::string_view part) {
        return read_whole<int>(option, part, 0, std::numeric_limits<int>::max());
    };
    return {coordinate(parts[0]), coordinate(parts[1])};
}

RenderSettings settings_of_pixel(const ExplainOptions& options, const Scene& scene) {
    RenderSettings settings = settings_of(options.render, scene);
    settings.depth = scene.depth;
    if (const auto& depths = options.render.depths) {
        if (depths->size() != 1) throw Error(ExitCode::usage, "--depth: a pixel is explained at one depth");
        settings.depth = depths->front();
    }
    const Resolution& size = settings.resolution;
    if (options.pixel.x >= size.width || options.pixel.y >= size.height) {
        throw Error(ExitCode::usage, fmt::format("--pixel {},{} is outside the image, which is {}x{}",
                                                 options.pixel.x, options.pixel.y, size.width, size.height));
    }
    return settings;
}

ExitCode explain(const ExplainOptions& options, const CommonOptions& common) {
    const Scene scene = load_scene(options.render.scene, options.render.loading);
    const RenderSettings settings = settings_of_pixel(options, scene);
    DeviceOptions device_options = common.device;
    device_options.traversal = options.render.traversal;
    Device device(device_options);
    take_driver_failures();
    device.memory().set_limit(options.render.max_memory.value_or(physical_memory_bytes()));
    RenderSettings pixel_settings = settings;
    pixel_settings.crop = Crop{options.pixel.x, options.pixel.y, options.pixel.x + 1, options.pixel.y + 1};
    const auto lights = static_cast<std::uint32_t>(scene.lights.size());
    Renderer renderer(device, scene, {}, options.render.build_quality,
                      compilation_for(memory_request(device, pixel_settings, lights)));
    const ExplainedPixel pixel{scene,           options.render,
                               settings,        options.pixel.x,
                               options.pixel.y, renderer.explain(settings, options.pixel.x, options.pixel.y)};
    if (common.json) {
        print_explanation(pixel);
    } else {
        print(explanation_text(pixel));
    }
    return ExitCode::ok;
}

}  // namespace

Command add_explain_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<ExplainOptions>();
    CLI::App* command = app.add_subcommand("explain", "says where the light of a pixel comes from");
    add_scene_argument(*command, "SCENE", options->render.scene);
    add_value(
        *command, "--pixel", "X,Y",
        [options](const std::string& text) { options->pixel = read_pixel("--pixel", text); },
        "which, from 0,0 at the top left")
        ->required();
    add_scene_options(*command, options->render.loading);
    add_view_options(*command, options->render);
    add_tree_options(*command, options->render.build_quality, options->render.traversal);
    add_memory_limit(*command, options->render.max_memory);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "A line for each ray of the pixel's ray tree, below the ray that it comes from: what it meets and "
        "how\n"
        "far away, its weight, what it adds to the pixel, and of each light whether it is lit, blocked,\n"
        "filtered by transparent surfaces, or brings nothing (-). The contributions add up to the pixel of\n"
        "'sahl render' with the same options, exactly.\n"
        "With --json all there is of each ray.\n"
        "Examples:\n"
        "  sahl explain scene.json --pixel 320,240\n"
        "  sahl explain scene.json --pixel 0,0 --size 1920x1080 --camera top --depth 2\n"
        "  sahl explain scene.json --pixel 320,240 --spp 16 --samples 3..4 --json");
    return {command, [options, &common] { return explain(*options, common); }};
}

}  // namespace sahl::cli
