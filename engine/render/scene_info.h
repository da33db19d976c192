// What is in a scene, what its trees look like and what memory a render of it takes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/accel/bounds.h"
#include "engine/accel/bvh.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Bytes of what a render holds at the same time, at the default ray budget, one sample a pixel and
/// the scene's depth and size. The OpenCL driver's own memory and that of encoding come on top.
struct MemoryPlan {
    std::uint64_t nodes = 0;
    std::uint64_t leaf_blocks = 0;
    std::uint64_t shapes = 0;  ///< what shading looks up
    std::uint64_t instances = 0;
    std::uint64_t materials = 0;  ///< textures and lights too
    std::uint64_t ray_queues = 0;
    std::uint64_t film = 0;

    std::uint64_t total() const {
        return nodes + leaf_blocks + shapes + instances + materials + ray_queues + film;
    }
};

struct SceneInfo {
    std::array<std::uint64_t, 6> primitives{};  ///< by PrimitiveKind, each group's once
    std::uint64_t placed_primitives = 0;        ///< with a group's primitives once for each of its places
    std::uint64_t instances = 0;                ///< as written: in the world and in groups
    std::uint64_t placed_instances = 0;         ///< nested ones once for each place
    std::array<std::uint64_t, 3> lights{};      ///< by LightKind
    Bounds bounds{};          ///< the tree's, a little larger than the world; zeros if empty
    BvhStatistics bvh;        ///< of the world, where an instance counts as one primitive
    std::uint64_t trees = 1;  ///< the world's and those of instanced groups
    std::uint64_t nodes = 0;  ///< of all trees
    std::uint64_t leaves = 0;
    MemoryPlan memory;
    std::vector<std::string> unused_materials;  ///< that no primitive has
    std::vector<std::string> unused_groups;     ///< that no chain of instances leads to from the world
};

/// Lowers the scene and builds its trees, as a render would, without a device. Errors as
/// make_host_scene.
SceneInfo describe_scene(const Scene& scene);

}  // namespace sahl
