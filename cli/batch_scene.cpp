#include "cli/batch_scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/scene/scene_hash.h"

namespace sahl::cli {

namespace {

RenderSettings settings_of(const BatchJob& job, const Scene& outline) {
    RenderSettings settings;
    settings.resolution = job.settings.size.value_or(outline.resolution);
    settings.depth = job.settings.depth.value_or(outline.depth);
    settings.spp = job.settings.spp.value_or(1);
    settings.seed = job.settings.seed.value_or(0);
    return settings;
}

Camera find_camera(const BatchJob& job, const Scene& outline) {
    if (job.view) return *job.view;
    if (job.camera.empty()) return outline.cameras.front();
    std::vector<std::string_view> names;
    for (const Camera& camera : outline.cameras) {
        if (camera.name == job.camera) return camera;
        names.emplace_back(camera.name);
    }
    throw Error(ExitCode::scene, fmt::format("{} has no camera '{}'{}; it has {}", job.scene.string(),
                                             job.camera, did_you_mean(job.camera, names), join_names(names)));
}

void check_unchanged(const BatchJob& job, const SceneContent& content) {
    if (is_unchanged(content)) return;
    throw Error(ExitCode::scene,
                fmt::format("{} or a file that it uses was changed after the batch began; call it "
                            "again",
                            job.scene.string()));
}

}  // namespace

MemoryRequest BatchScene::request_of(const BatchJob& job, const RenderSettings& settings) {
    const std::vector<Aov> no_aovs;
    const std::vector<Aov>& aovs = job.settings.aovs ? *job.settings.aovs : no_aovs;
    MemoryRequest request = with_aovs(memory_request(device_, settings, light_count_), aovs);
    const std::vector<OutputSettings> encodings = settings_for(job.outputs, encoding_of(job.settings));
    for (std::size_t i = 0; i < job.outputs.size(); ++i) {
        const std::vector<Aov>& layers = can_hold_aovs(job.outputs[i]) ? aovs : no_aovs;
        request.encoder =
            std::max(request.encoder, encoder_bytes(job.outputs[i], encodings[i], settings.resolution.width,
                                                    settings.resolution.height, layers));
    }
    request.writes_behind = true;
    return request;
}

bool BatchScene::load(const BatchJob& job, const SceneContent& content, const Key& key) {
    // Before and after: what is loaded is what the record speaks of.
    check_unchanged(job, content);
    Scene scene = load_scene(job.scene, {job.parameters, job.asset_root});
    check_unchanged(job, content);
    light_count_ = static_cast<std::uint32_t>(scene.lights.size());
    outline_ = Scene();
    outline_.cameras = scene.cameras;
    outline_.resolution = scene.resolution;
    outline_.depth = scene.depth;
    const std::uint64_t hash = hash_without_cameras(scene);
    const bool is_same = key_ && hash_ == hash && key_->quality == key.quality;
    if (!is_same) {
        key_.reset();
        const MemoryRequest request = request_of(job, settings_of(job, outline_));
        if (renderer_) {
            renderer_->set_scene(scene, request, key.quality);
        } else {
            renderer_ = std::make_unique<Renderer>(device_, scene, request, key.quality);
        }
        hash_ = hash;
    }
    key_ = key;
    return !is_same;
}

PreparedJob BatchScene::prepare(const BatchJob& job, const SceneContent& content) {
    const Key key{job.scene, job.asset_root, job.parameters,
                  job.settings.build_quality.value_or(BuildQuality::high)};
    const bool loaded = key_ != key;
    const bool built = loaded && load(job, content, key);
    PreparedJob prepared{settings_of(job, outline_), {}, {}, loaded, built};
    const Camera camera = find_camera(job, outline_);
    prepared.camera = camera.name;
    renderer_->set_cameras({camera});
    renderer_->set_job(request_of(job, prepared.settings));
    prepared.plan = renderer_->memory_plan();
    prepared.settings.ray_budget = prepared.plan.ray_budget;
    return prepared;
}

}  // namespace sahl::cli
