// The scene that a worker has on its device, kept from job to job.
#pragma once

#include <memory>
#include <optional>

#include "cli/batch_setup.h"

namespace sahl::cli {

/// What rendering a job takes.
struct PreparedJob {
    RenderSettings settings;
    std::string camera;  ///< its name
    MemoryPlan plan;
    bool loaded = false;  ///< the scene's files were read for it
    bool built = false;   ///< so was the tree built
};

/// Builds as little as possible: nothing for the same scene again or another camera, only the scene for
/// another one. Kernels are compiled once.
class BatchScene {
public:
    explicit BatchScene(Device& device) : device_(device) {}

    /// Makes `job`'s scene, camera and memory plan ready. Throws Error as the loaders and the renderer, and
    /// Error(scene) when a file is not what it was when `content` was taken.
    PreparedJob prepare(const BatchJob& job, const SceneContent& content);
    Renderer& renderer() { return *renderer_; }

private:
    struct Key {
        std::filesystem::path scene;
        std::optional<std::filesystem::path> asset_root;
        std::vector<std::pair<std::string, std::string>> parameters;
        BuildQuality quality;
        bool operator==(const Key&) const = default;
    };
    /// Whether anything had to be built.
    bool load(const BatchJob& job, const SceneContent& content, const Key& key);
    MemoryRequest request_of(const BatchJob& job, const RenderSettings& settings);

    Device& device_;
    std::unique_ptr<Renderer> renderer_{};
    std::optional<Key> key_{};  ///< of what `renderer_` has; none: nothing
    std::uint64_t hash_ = 0;    ///< of it, see hash_without_cameras
    Scene outline_{};           ///< cameras, resolution and depth of it
    std::uint32_t light_count_ = 0;
};

}  // namespace sahl::cli
