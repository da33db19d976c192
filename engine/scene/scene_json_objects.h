// Objects of a Sahl scene: the shapes, group objects, instances and includes.
#pragma once

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// An array of objects, into `around.target`.
void read_objects(JsonSceneState& state, const JsonValue& value, const Surroundings& around);

}  // namespace sahl
