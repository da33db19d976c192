// `sahl profile`: where the time of a frame goes.
#include <memory>

#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/interruption.h"
#include "cli/profile_options.h"
#include "cli/profile_table.h"
#include "cli/render_settings.h"
#include "cli/standard_output.h"
#include "engine/core/atomic_file.h"
#include "engine/profile/chrome_trace.h"
#include "engine/profile/environment.h"
#include "engine/profile/measure.h"
#include "engine/profile/profile_csv.h"
#include "engine/profile/profile_json.h"

#include <nlohmann/json.hpp>

namespace sahl::cli {

namespace {

/// What is found wrong before a long measurement.
void check_files(const ProfileOptions& options) {
    for (const auto& file : {options.json, options.csv, options.trace}) {
        if (file) check_output_file(*file);
    }
}

FrameJob plan_frame(const ProfileOptions& options, const Scene& scene) {
    FrameJob job;
    job.settings = settings_of(options.render, scene);
    job.settings.depth = scene.depth;
    if (const auto& depths = options.render.depths) {
        if (depths->size() != 1) throw Error(ExitCode::usage, "--depth: a profile is of one depth");
        job.settings.depth = depths->front();
    }
    job.output = options.render.outputs.empty() ? "/dev/null" : options.render.outputs.front();
    check_output(job.output, job.encoding);
    return job;
}

MemoryRequest request_of(const FrameJob& job, const Device& device, const Scene& scene) {
    MemoryRequest request =
        memory_request(device, job.settings, static_cast<std::uint32_t>(scene.lights.size()));
    const Resolution size = image_size(job.settings);
    request.encoder = encoder_bytes(job.output, job.encoding, size.width, size.height, {});
    return request;
}

void describe_job(const ProfileOptions& options, const FrameJob& job, const Scene& scene,
                  ProfileEnvironment& environment) {
    const RenderSettings& settings = job.settings;
    environment.scene = options.render.scene;
    environment.scene_hash = scene_hash(scene, settings.camera);
    environment.camera = scene.cameras[settings.camera].name;
    environment.width = settings.resolution.width;
    environment.height = settings.resolution.height;
    if (const auto& crop = settings.crop) environment.crop = {{crop->x0, crop->y0, crop->x1, crop->y1}};
    environment.depth = settings.depth;
    environment.spp = settings.spp;
    environment.seed = settings.seed;
    environment.build_quality = options.render.build_quality == BuildQuality::high ? "high" : "fast";
}

/// The scene ready to be rendered, with all that happened until then.
struct Prepared {
    std::unique_ptr<Device> device;
    std::unique_ptr<Renderer> renderer;
    FrameJob job;
    Measurement measurement;  ///< of it the setup and what is known of the environment
};

Prepared prepare(const ProfileOptions& options, const CommonOptions& common) {
    Prepared out;
    TimelineRecorder recorder;
    Scene scene = load_scene(options.render.scene, options.render.loading);
    out.job = plan_frame(options, scene);
    {
        const HostStep step("open device");
        DeviceOptions device_options = common.device;
        device_options.traversal = options.render.traversal;
        out.device = std::make_unique<Device>(device_options);
        take_driver_failures();
    }
    Device& device = *out.device;
    recorder.add(device);
    device.memory().set_limit(options.render.max_memory.value_or(physical_memory_bytes()));
    const MemoryRequest request = request_of(out.job, device, scene);
    out.renderer = std::make_unique<Renderer>(device, scene, request, options.render.build_quality);
    out.job.settings.ray_budget = out.renderer->memory_plan().ray_budget;
    ClockOffset clock;
    {
        const HostStep step("align clocks");
        clock = measure_clock(device);
    }
    out.measurement.setup = recorder.stop(device, clock);
    out.measurement.compiles_in_setup = count_compilations();
    out.measurement.lights = static_cast<std::uint32_t>(scene.lights.size());
    describe_job(options, out.job, scene, out.measurement.environment);
    out.measurement.environment.ray_budget = out.job.settings.ray_budget;
    describe_device(device, out.measurement.environment);
    return out;
}

void check_interruption() {
    if (interruption().stop_requested())
        throw Interrupted("the profile is not finished, nothing of it is saved");
}

Measurement take_measurement(const ProfileOptions& options, const CommonOptions& common) {
    Prepared prepared = prepare(options, common);
    MeasureOptions how{options.warm_up, options.repeat};
    Measurement measured =
        measure(*prepared.device, *prepared.renderer, prepared.job, how, check_interruption);
    ProfileEnvironment environment = std::move(prepared.measurement.environment);
    environment.clock_uncertainty_ns = measured.environment.clock_uncertainty_ns;
    environment.overhead_percent = measured.environment.overhead_percent;
    environment.warm_up = measured.environment.warm_up;
    measured.environment = std::move(environment);
    measured.setup = std::move(prepared.measurement.setup);
    measured.compiles_in_setup = prepared.measurement.compiles_in_setup;
    measured.lights = prepared.measurement.lights;
    return measured;
}

void write_text(const std::optional<std::string>& file, const std::string& text,
                const CommonOptions& common) {
    write_file(*file, std::as_bytes(std::span(text)));
    if (!common.quiet) fmt::print(stderr, "wrote {}\n", *file);
}

void write_reports(const ProfileOptions& options, const Profile& profile, const Measurement& measurement,
                   const CommonOptions& common) {
    if (options.json) write_text(options.json, profile_json(profile), common);
    if (options.csv) write_text(options.csv, profile_csv(profile), common);
    if (options.trace) write_text(options.trace, chrome_trace(measurement), common);
}

ExitCode run_profile(const ProfileOptions& options, const CommonOptions& common) {
    if (options.render.scene.empty()) {
        throw Error(ExitCode::usage, "SCENE is required\n'sahl profile --help' shows what there is");
    }
    check_files(options);
    const Measurement measurement = take_measurement(options, common);
    const Profile profile = summarize(measurement);
    defer_interruption();  // reports become whole
    write_reports(options, profile, measurement, common);
    if (common.json) {
        nlohmann::ordered_json event{{"event", "profile"}};
        event.update(nlohmann::ordered_json::parse(profile_json(profile)));
        print_event(event);
    } else {
        print(profile_text(profile));
    }
    const std::uint64_t compiled = profile.compiles_in_setup + profile.compiles_during_render;
    if (options.assert_no_jit && compiled > 0) {
        throw Error(
            ExitCode::performance,
            fmt::format("--assert-no-jit: {} kernels were compiled, {} of them while frames were rendered; "
                        "'sahl warm' compiles them beforehand",
                        compiled, profile.compiles_during_render));
    }
    return ExitCode::ok;
}

}  // namespace

Command add_profile_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<ProfileOptions>();
    CLI::App* command = app.add_subcommand("profile", "measures where the time of a frame goes, or compares");
    add_profile_options(*command, *options);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "Frames are rendered, encoded and written again and again. The table has a row for each kernel and\n"
        "generation of rays: rays in and out, time, speed, bytes and operations beside what the device can "
        "do\n"
        "at most; nodes and leaves that rays visit are counted in a frame of its own. A frame's wall clock "
        "is\n"
        "the time that the device was busy and that it was idle, this by the step that the host was at.\n"
        "docs/profile.md says what each figure means.\n"
        "Examples:\n"
        "  sahl profile balls.nff\n"
        "  sahl profile scene.json --size 1920x1080 --depth 7 --repeat 20\n"
        "  sahl profile balls.nff --export-json balls.json --export-trace trace.json\n"
        "  sahl profile balls.nff --assert-no-jit -q --export-csv rows.csv\n"
        "  sahl profile diff before.json after.json");
    return {command, [options, &common] { return run_profile(*options, common); }};
}

}  // namespace sahl::cli
