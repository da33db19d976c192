// Polygons and triangle meshes of a Sahl scene.
#pragma once

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// A polygon of at least 3 vertices in a plane. `around` is the polygon's own.
void read_polygon(JsonSceneState& state, const JsonObject& object, const Surroundings& around);

/// A triangle mesh. Triangles without area, which no ray can hit, are left out.
void read_mesh(JsonSceneState& state, const JsonObject& object, const Surroundings& around);

}  // namespace sahl
