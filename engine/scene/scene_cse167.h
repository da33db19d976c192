// The text format of the CSE 167 ray tracer homework, `.test`.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/text_reader.h"

namespace sahl {

/// Of rays, that a scene may ask for.
inline constexpr int cse167_largest_depth = 1000;

/// Reads CSE 167: one command a line, `size` first.
///
/// What the format leaves open is decided so: `attenuation` is global, the last one in the file holds
/// for all point lights; matrices multiply from the right, as in OpenGL; vertices and normals are
/// stored as they are written and placed by the object's transform; normals are made unit length;
/// materials are one-sided Blinn materials that mirror their specular colour; shininess is 1 until it
/// is set; triangles without area, which no ray can hit, are left out.
///
/// Throws SceneError, also for an unknown command and for values left on a line.
/// Source: Ramamoorthi's file format page for CSE 167, homework "ray tracer".
Scene read_cse167(TextReader& reader);

}  // namespace sahl
