// What a scene takes of memory: on the host while it is made ready, then on the device.
#pragma once

#include <cstdint>

#include "engine/scene/scene.h"

namespace sahl {

struct HostScene;

/// Bytes that a scene takes, on the host while it is made ready for the device and on the device.
struct SceneMemory {
    std::uint64_t loaded = 0;    ///< the Scene
    std::uint64_t building = 0;  ///< beside it until its trees are built and all is uploaded, at most
    std::uint64_t nodes = 0;     ///< from here on the device's
    std::uint64_t leaf_blocks = 0;
    std::uint64_t shapes = 0;  ///< what shading looks up
    std::uint64_t instances = 0;
    std::uint64_t materials = 0;  ///< textures and lights too

    std::uint64_t device() const { return nodes + leaf_blocks + shapes + instances + materials; }
};

/// What is known before the trees are built: nothing is less than measure_scene_memory() finds.
/// Errors as place_instances.
SceneMemory bound_scene_memory(const Scene& scene);

/// The sizes of what was built of `scene`; `building` is that of its bound.
SceneMemory measure_scene_memory(const Scene& scene, const HostScene& host, const SceneMemory& bound);

}  // namespace sahl
