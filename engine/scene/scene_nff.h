// Haines' Neutral File Format, the format of the Standard Procedural Databases.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/text_reader.h"

namespace sahl {

/// Reads NFF: entities b v l f c s p pp and # comments, in any layout of lines.
///
/// What the format leaves open is decided so: `angle` is the full vertical angle between the image's
/// edges; `hither` is ignored; n lights without a colour have 1/sqrt(n) each, n counted over the
/// whole file; a material mirrors its Ks and transmits its T in all channels, its highlight is Ks
/// in the light's colour (Phong), there is no ambient light; the depth is 4. A patch (`pp`) of more
/// than three corners is divided into triangles. Polygons and patches without area, which no ray can
/// hit, are left out.
///
/// Throws SceneError, also for what would lose meaning: an object before any `f`, a second `v` or
/// `b`, a missing `v`, a polygon that lies in no plane.
/// Source: Haines, NFF version 3.9 (NFF.TXT of the SPD package).
Scene read_nff(TextReader& reader);

}  // namespace sahl
