// Other scene files inside a Sahl scene.
#pragma once

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// Reads the file that an include names and adds its scene to `around.target`; `around` has the
/// include's own transform, material and sides. Throws SceneError: at the include for what is wrong
/// with it, a missing file among that; in the file for what is wrong there.
void read_include(JsonSceneState& state, const JsonObject& object, const Surroundings& around);

}  // namespace sahl
