// A scene in Haines' Neutral File Format.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace sahl {

/// The scene as NFF that read_nff() turns into the same scene again. Triangles without area, which
/// read_nff() leaves out, are left out here.
/// Texture coordinates are left out: no texture is there to use them.
/// Throws Error(scene) that names the first thing the format has no words for: other depths than
/// 4, several cameras, transforms, groups, discs, boxes, ambient light, textures, Blinn highlights, …
std::string write_nff(const Scene& scene);

}  // namespace sahl
