#include "cli/profile_setup.h"

#include <fmt/format.h>

#include "cli/driver_failure.h"
#include "cli/interruption.h"
#include "cli/render_settings.h"
#include "engine/profile/environment.h"
#include "engine/scene/scene_hash.h"

namespace sahl::cli {

namespace {

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

MemoryRequest request_of(const ProfileOptions& options, const FrameJob& job, const Device& device,
                         const Scene& scene) {
    MemoryRequest request =
        memory_request(device, job.settings, static_cast<std::uint32_t>(scene.lights.size()));
    if (options.html) request = with_aovs(request, costs_of_page);
    const Resolution size = image_size(job.settings);
    request.encoder = encoder_bytes(job.output, job.encoding, size.width, size.height, {});
    return request;
}

void describe_job(const ProfileOptions& options, const FrameJob& job, const Scene& scene,
                  ProfileEnvironment& environment) {
    const RenderSettings& settings = job.settings;
    environment.scene = options.render.scene;
    const Camera& camera = scene.cameras[settings.camera];
    environment.scene_hash = fmt::format("{:016x}", hash_with_camera(scene, camera));
    environment.camera = camera.name;
    environment.width = settings.resolution.width;
    environment.height = settings.resolution.height;
    if (const auto& crop = settings.crop) environment.crop = {{crop->x0, crop->y0, crop->x1, crop->y1}};
    environment.depth = settings.depth;
    environment.spp = settings.spp;
    environment.seed = settings.seed;
    environment.build_quality = options.render.build_quality == BuildQuality::high ? "high" : "fast";
}

}  // namespace

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
    const MemoryRequest request = request_of(options, out.job, device, scene);
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

}  // namespace sahl::cli
