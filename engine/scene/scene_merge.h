// One scene put into another.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// How a scene is put into another.
struct MergePlan {
    /// For each of its materials the index of the outer material that takes its place, or `keep`.
    static constexpr std::uint32_t keep = 0xffffffff;
    std::vector<std::uint32_t> materials;
    std::optional<Sides> sides{};      ///< of all primitives, if any
    const JsonValue* value = nullptr;  ///< what all is placed by, for messages
};

/// Adds a scene, without its lights and cameras, to the target of `around` and to `state`: its world
/// under `around`'s transform, its groups as they are. Throws SceneError at the plan's value if a
/// primitive of its world ends up out of range.
void merge_scene(JsonSceneState& state, const Scene& scene, const MergePlan& plan,
                 const Surroundings& around);

}  // namespace sahl
