#include "cli/render_settings.h"

namespace sahl::cli {

namespace {

void check_crop(const Crop& crop, const Resolution& resolution) {
    if (crop.x1 <= resolution.width && crop.y1 <= resolution.height) return;
    throw Error(ExitCode::usage,
                fmt::format("--crop {},{},{},{} reaches outside the image, which is {}x{}", crop.x0, crop.y0,
                            crop.x1, crop.y1, resolution.width, resolution.height));
}

void check_samples(const SampleRange& samples, int spp) {
    if (samples.end <= spp) return;
    throw Error(ExitCode::usage,
                fmt::format("--samples {}..{} reaches beyond --spp {}", samples.begin, samples.end, spp));
}

std::size_t find_camera(const Scene& scene, const std::optional<std::string>& name) {
    if (!name) return 0;
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (scene.cameras[i].name == *name) return i;
        names.emplace_back(scene.cameras[i].name);
    }
    throw Error(ExitCode::usage,
                fmt::format("--camera '{}': the scene has no camera of that name{}; it has {}", *name,
                            did_you_mean(*name, names), join_names(names)));
}

}  // namespace

RenderSettings settings_of(const RenderOptions& options, const Scene& scene) {
    RenderSettings settings;
    settings.resolution = options.size.value_or(scene.resolution);
    settings.spp = options.spp;
    settings.samples = options.samples;
    if (options.samples) check_samples(*options.samples, options.spp);
    settings.seed = options.seed;
    settings.crop = options.crop;
    settings.camera = find_camera(scene, options.camera);
    if (options.crop) check_crop(*options.crop, settings.resolution);
    return settings;
}

Resolution image_size(const RenderSettings& settings) {
    if (const auto& crop = settings.crop) return {crop->x1 - crop->x0, crop->y1 - crop->y0};
    return settings.resolution;
}

}  // namespace sahl::cli
