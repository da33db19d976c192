// Triangles as meshes of a Sahl scene.
#pragma once

#include <cstdint>

#include "engine/scene/json_layout.h"
#include "engine/scene/scene.h"

namespace sahl {

/// The end of the primitives from `first` on, before `end`, that can be one mesh: triangles that share
/// material, transform and sides. `first` itself if it is no triangle.
std::uint32_t mesh_end(const Scene& scene, std::uint32_t first, std::uint32_t end);

/// Those primitives as a mesh without its material, transform and sides. Corners that are the same to
/// the last bit are one vertex. A transform without an inverse, which a Sahl scene may not have, is
/// applied to the vertices: then the mesh is to have none.
JsonLayout mesh_layout(const Scene& scene, std::uint32_t first, std::uint32_t end);

}  // namespace sahl
