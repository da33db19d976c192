// What is in a scene, what its trees look like and what memory a render of it takes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/accel/bounds.h"
#include "engine/accel/bvh.h"
#include "engine/render/memory_plan.h"
#include "engine/scene/scene.h"

namespace sahl {

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
    MemoryPlan memory;  ///< of a render at the scene's depth and size, one sample a pixel, no files
    std::vector<std::string> unused_materials;  ///< that no primitive has
    std::vector<std::string> unused_groups;     ///< that no chain of instances leads to from the world
};

/// Lowers the scene and builds its trees, as a render would, without a device. Errors as
/// make_host_scene.
SceneInfo describe_scene(const Scene& scene);

}  // namespace sahl
