// "transform" of a Sahl scene: one step or an array of steps.
#pragma once

#include <glm/mat4x4.hpp>

#include "engine/scene/scene_json_values.h"

namespace sahl {

/// The steps' product, the first step applied first. A single matrix step is that matrix to the bit.
/// Throws SceneError, also for what has no inverse.
glm::dmat4 read_transform(const JsonReader& reader, const JsonValue& value);

}  // namespace sahl
