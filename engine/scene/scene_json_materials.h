// Materials and textures of a Sahl scene.
#pragma once

#include <cstdint>

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// All of "materials", in the order of the file.
void read_materials(JsonSceneState& state, const JsonValue& value);

/// The index of a material that is given by its name or written out.
std::uint32_t read_material_reference(JsonSceneState& state, const JsonValue& value);

/// What objects without a material have: the file's material "default", else a grey one of that name.
std::uint32_t default_material(JsonSceneState& state);

/// Three numbers c0, c1, c2 that are not negative and not all 0: division by c0 + c1 d + c2 d².
glm::vec3 read_attenuation(const JsonObject& object);

}  // namespace sahl
