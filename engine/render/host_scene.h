// A scene in host memory as devices take it: lowered, with the trees of the world and of all groups.
#pragma once

#include <vector>

#include "engine/accel/bvh.h"
#include "engine/render/lower_scene.h"
#include "engine/scene/scene.h"
#include "kernels/device_types.h"

namespace sahl {

struct HostScene {
    LoweredScene lowered;  ///< without build_primitives, which the trees have taken
    /// The world's tree, [0] its root, and behind it the trees of the groups that are instanced.
    /// Bounds and statistics are the world's, in which an instance counts as one primitive.
    Bvh bvh;
    std::vector<device::DeviceInstance> instances;  ///< instance i + 1; of groups without primitives too
    device::SceneConstants constants{};
};

/// Errors as lower_scene, build_bvh and place_instances; Error(scene) for an instance whose transforms
/// together have no inverse or leave float's range.
HostScene make_host_scene(const Scene& scene, BuildQuality quality = BuildQuality::high);

}  // namespace sahl
