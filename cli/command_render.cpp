// `sahl render`: a scene to one image, or to one image for each depth.
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <new>

#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/interruption.h"
#include "cli/memory_report.h"
#include "cli/options.h"
#include "cli/output_name.h"
#include "cli/render_files.h"
#include "cli/render_options.h"
#include "cli/render_report.h"
#include "cli/render_settings.h"
#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/film/early_encoder.h"
#include "engine/film/image_io.h"
#include "engine/render/pixel_order.h"

namespace sahl::cli {

namespace {

/// What is written for each depth, checked.
std::vector<std::vector<Output>> plan_outputs(const RenderOptions& options, const std::vector<int>& depths) {
    std::vector<std::vector<Output>> plan;
    for (const std::vector<std::filesystem::path>& paths :
         output_names(options.outputs, options.scene, depths)) {
        const std::vector<OutputSettings> encodings = settings_for(paths, options.encoding);
        std::vector<Output>& outputs = plan.emplace_back();
        for (std::size_t i = 0; i < paths.size(); ++i) {
            check_output(paths[i], encodings[i]);
            outputs.push_back({paths[i], encodings[i]});
        }
        if (!options.aovs.empty() && std::none_of(paths.begin(), paths.end(), can_hold_aovs)) {
            throw Error(ExitCode::usage,
                        fmt::format("--aov: '{}' has no room for AOVs; add an EXR file: -o '{}'",
                                    paths.front().string(),
                                    std::filesystem::path(paths.front()).replace_extension(".exr").string()));
        }
    }
    return plan;
}

ProgressStyle progress_style(const CommonOptions& common) {
    if (common.quiet) return ProgressStyle::none;
    return isatty(STDERR_FILENO) != 0 ? ProgressStyle::bar : ProgressStyle::lines;
}

/// The most bytes that one of the files takes while it is encoded.
std::uint64_t largest_encoder(const std::vector<std::vector<Output>>& outputs, const Resolution& size,
                              const std::vector<Aov>& aovs) {
    std::uint64_t largest = 0;
    for (const std::vector<Output>& files : outputs) {
        for (const Output& file : files) {
            const std::span<const Aov> layers =
                can_hold_aovs(file.path) ? std::span(aovs) : std::span<const Aov>();
            largest =
                std::max(largest, encoder_bytes(file.path, file.encoding, size.width, size.height, layers));
        }
    }
    return largest;
}

Job plan_job(const RenderOptions& options, const Scene& scene) {
    Job job;
    job.settings = settings_of(options, scene);
    job.camera = scene.cameras[job.settings.camera].name;
    job.depths = options.depths.value_or(std::vector<int>{scene.depth});
    job.outputs = plan_outputs(options, job.depths);
    return job;
}

MemoryRequest request_of(const Job& job, const Device& device, const Scene& scene,
                         const std::vector<Aov>& aovs) {
    RenderSettings deepest = job.settings;
    deepest.depth = *std::max_element(job.depths.begin(), job.depths.end());
    const auto lights = static_cast<std::uint32_t>(scene.lights.size());
    MemoryRequest request = with_aovs(memory_request(device, deepest, lights), aovs);
    request.encoder = largest_encoder(job.outputs, image_size(job.settings), aovs);
    return request;
}

Rendered render_image(Renderer& renderer, Device& device, const RenderSettings& settings,
                      const std::vector<Output>& outputs, const std::vector<AovImage>& aovs,
                      const std::string& camera, const MemoryPlan& plan, const RenderOptions& options,
                      const CommonOptions& common) {
    Rendered result{outputs, camera, settings, image_size(settings), {}, 0, 0};
    const int samples = sample_count(settings);
    Film film(device.memory(), result.size.width, result.size.height);
    const MemoryReservation file(device.memory(), plan.encoder, "the image's file");
    std::optional<EarlyEncoder> early;
    if (const Output& first = outputs.front(); can_encode_early(first.path))
        early.emplace(film, samples, first.path, first.encoding);
    {
        Progress progress(std::cerr, progress_style(common), fmt::format("depth {}", settings.depth),
                          "samples");
        result.statistics = renderer.render(
            settings, film,
            [&](std::uint64_t done, std::uint64_t all) {
                defer_interruption();  // there is an image to save
                // Now, as loading keeps PoCL from loading kernels.
                for (const Output& output : outputs) load_encoder(output.path);
                const std::uint64_t pixels = done / static_cast<std::uint64_t>(samples);
                if (early) early->set_finished(finished_rows(pixels, result.size.width, result.size.height));
                progress.update(done, all);
            },
            interruption());
    }
    result.non_finite = film.non_finite_count();
    result.clamped = film.clamped_count();
    const MemoryReservation pixels(device.memory(), plan.image, "the image");
    if (is_partial(result)) {
        early.reset();
        save_partial(result, film.resolve(samples), aovs, options, device.info());
    }
    const std::span<const Output> later = std::span(outputs).subspan(early ? 1 : 0);
    if (early) early->write(metadata(result, options, device.info()));
    early.reset();
    if (!later.empty()) write_files(result, later, film.resolve(samples), aovs, options, device.info());
    return result;
}

/// Renders and writes all images of `job`, whose scene is in `renderer`.
void render_job(Job& job, Renderer& renderer, Device& device, const MemoryPlan& plan,
                const RenderOptions& options, const CommonOptions& common) {
    job.settings.ray_budget = plan.ray_budget;
    const MemoryReservation layers(device.memory(), plan.aovs, "AOVs");
    const bool with_costs = std::any_of(options.aovs.begin(), options.aovs.end(), is_cost);
    std::vector<AovImage> aovs;
    for (std::size_t i = 0; i < job.depths.size(); ++i) {
        if (interruption().stop_requested()) {
            throw Interrupted(fmt::format("{} of {} images are written", i, job.depths.size()));
        }
        job.settings.depth = job.depths[i];
        if (i == 0 || with_costs) {  // the others are the same at every depth
            aovs.clear();
            aovs = renderer.render_aovs(job.settings, options.aovs, interruption());
        }
        const Rendered image = render_image(renderer, device, job.settings, job.outputs[i], aovs, job.camera,
                                            plan, options, common);
        warn_of_lost_light(image);
        if (!common.quiet) say_image(image);
        if (common.json) print_image(image);
    }
}

ExitCode render(const RenderOptions& options, const CommonOptions& common) {
    Scene scene = load_scene(options.scene, options.loading);
    Job job = plan_job(options, scene);
    DeviceOptions device_options = common.device;
    device_options.traversal = options.traversal;
    Device device(device_options);
    take_driver_failures();
    log_debug(fmt::format("device {} ({}), driver {}", device.info().name, device.info().platform,
                          device.info().driver));
    device.memory().set_limit(options.max_memory.value_or(physical_memory_bytes()));
    const MemoryRequest request = request_of(job, device, scene, options.aovs);
    if (options.dry_run) {
        const std::uint64_t limit = device.memory().limit();
        print_dry_run(options, job, device.info(), plan_render(scene, request, limit, options.build_quality),
                      limit, common.json);
        return ExitCode::ok;
    }

    const Compilation compilation = compilation_for(request, job.depths.size());
    Renderer renderer(device, scene, request, options.build_quality, compilation);
    scene = Scene();  // the renderer has its own
    const MemoryPlan& plan = renderer.memory_plan();
    const BvhStatistics& bvh = renderer.bvh_statistics();
    log_debug(fmt::format("{} primitives; tree of {} nodes, {} levels, built in {:.2f} s", bvh.primitives,
                          bvh.nodes, bvh.depth, bvh.build_seconds));
    log_debug(
        fmt::format("memory: {} at most, batches of {} rays", human_size(plan.total()), plan.ray_budget));
    if (common.json) print_start(options, job, device.info(), bvh);
    render_job(job, renderer, device, plan, options, common);
    log_debug(fmt::format("memory: {} in use at one time", human_size(device.memory().peak())));
    return ExitCode::ok;
}

}  // namespace

Command add_render_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "renders a scene");
    add_render_options(*command, *options);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "Of several images each takes those of --pixel-type, --transfer, --rounding and --compression\n"
        "that its format can hold.\n"
        "AOVs are of sample 0 of each pixel, its first hit: Z the distance along the view axis (no hit: "
        "inf),\n"
        "N the unit normal and albedo the diffuse colour (no hit: 0), ids count from 0, id.instance 0 being "
        "the\n"
        "world (no hit: 4294967295). cost.rays and cost.nodes are what the pixel cost, all samples together, "
        "counted\n"
        "in a render of its own.\n"
        "SIGINT (Ctrl-C) and SIGTERM end it with the exit status 130 and 143. What is finished of the image "
        "is\n"
        "saved as NAME.partial.EXT, which later runs leave alone; other pixels are black. A second one ends "
        "it\n"
        "at once.\n"
        "Examples:\n"
        "  sahl render balls.nff\n"
        "  sahl render balls.nff -o balls.exr --size 1920x1080 --spp 16\n"
        "  sahl render balls.nff --depth 0,1,2,3,4,7 -o 'd{depth}.png'\n"
        "  sahl render scene.json --camera top --set radius=1.5 --set color=1,0,0\n"
        "  sahl render scene.json -o layers.exr -o preview.png --aov Z,N,albedo --compression piz\n"
        "  sahl render scene.json --size 16384x16384 --max-mem 8G --dry-run\n"
        "  sahl render scene.test -o exact.png --transfer linear --rounding floor");
    return {command, [options, &common] {
                try {
                    return render(*options, common);
                } catch (const std::bad_alloc&) {
                    throw Error(
                        ExitCode::memory,
                        fmt::format("out of memory: the scene or its image needs more than this machine "
                                    "has; 'sahl info {}' says what takes how much",
                                    options->scene));
                }
            }};
}

}  // namespace sahl::cli
