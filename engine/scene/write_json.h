// A scene as Sahl scene text.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace sahl {

/// The scene as a Sahl scene (`.json`) that reads as the same scene again: the same primitives in the
/// same order with the same numbers. Runs of triangles that share material, transform and sides
/// become one mesh, transforms one matrix each; names that occur twice get a number.
/// Throws Error(scene) for the little that the loaders never make: a depth above 64, a coloured
/// material under a texture.
std::string write_json(const Scene& scene);

}  // namespace sahl
