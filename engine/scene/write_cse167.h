// A scene in the text format of the CSE 167 ray tracer homework.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace sahl {

/// The scene as `.test` that read_cse167() turns into the same scene again. Transforms become
/// translate, rotate and scale where those give the same matrix to the last bit. Triangles
/// without area, which read_cse167() leaves out, are left out here.
/// Texture coordinates are left out: no texture is there to use them.
/// Throws Error(scene) that names the first thing the format has no words for: several cameras, a
/// background, groups, other shapes than triangles and spheres, transmission, textures, Phong
/// highlights, …
std::string write_cse167(const Scene& scene);

}  // namespace sahl
