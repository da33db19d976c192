// Rays through the engine's traversal kernels.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/rays.h"
#include "bench/statistics.h"
#include "engine/device/program.h"
#include "engine/render/device_scene.h"

namespace sahl::bench {

/// Ways of traversal: kernels intersect_<name> and occluded_<name>.
inline constexpr std::array sahl_kernels{"scalar", "packet", "stream"};

class SahlTracer {
public:
    /// Builds the kernels for a device.
    explicit SahlTracer(const DeviceOptions& options);

    Device& device() { return device_; }

    /// Builds the scene's tree; the rays are forgotten.
    void set_scene(const Scene& scene);
    const BvhStatistics& tree() const { return scene_->bvh_statistics; }

    void set_rays(const RaySet& rays);

    /// Traces all rays by the way of that name; returns the seconds from launch to finish.
    double trace(const std::string& way, Clock clock = Clock::wall);

    /// What the last trace() found.
    std::vector<RayHit> hits();

    /// All that the last trace() has written, for comparison bit by bit.
    std::vector<std::uint32_t> record();

private:
    struct Batch {
        Buffer rays, ids, t_max, hits, hit_ids;
        std::uint32_t capacity, count;
        bool occlusion;
    };

    /// What one work-item of a kernel takes.
    std::uint32_t rays_per_item_of(const std::string& way, bool occlusion) const;
    Kernel& kernel_of(const std::string& name);

    Device device_;
    Program program_;
    std::map<std::string, Kernel> kernels_;
    std::optional<DeviceScene> scene_;
    std::optional<Batch> batch_;
};

}  // namespace sahl::bench
