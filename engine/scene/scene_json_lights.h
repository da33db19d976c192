// Lights of a Sahl scene.
#pragma once

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// All of "lights": points, directional ones and spots into the scene's lights, ambient ones into
/// their sum.
void read_lights(JsonSceneState& state, const JsonValue& value);

}  // namespace sahl
