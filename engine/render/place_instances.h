// Nested instances as one list of groups in the world.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/scene/scene.h"

namespace sahl {

struct PlacedGroup {
    std::uint32_t group;  ///< in Scene::groups
    glm::dmat4 world_from_group;
};

/// Every instance of the scene, those inside of groups once for each place of the group: depth first,
/// an instance before those in its group. Element i is instance i + 1, as AOVs count them.
/// Throws Error(scene) for more than SAHL_CHILD_OFFSET_MASK of them and for groups nested deeper than
/// 64, which groups that contain themselves are.
std::vector<PlacedGroup> place_instances(const Scene& scene);

/// How many that are. Throws as place_instances.
std::uint64_t count_placed_instances(const Scene& scene);

}  // namespace sahl
