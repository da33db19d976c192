// Groups of a Sahl scene: no group contains itself, no instance reaches too far.
#pragma once

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// Throws SceneError at an instance that closes a cycle of groups, and at one that takes its group
/// beyond ±max_magnitude.
void check_groups(const JsonSceneState& state);

}  // namespace sahl
