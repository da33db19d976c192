// Arbitrary output variables: what the renderer knows of the first surface behind each pixel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sahl {

/// All of sample 0 of a pixel, at the first hit. Where there is none: depth infinite, normal and
/// albedo 0, ids `no_aov_id`.
enum class Aov {
    depth,         ///< distance from the plane through the eye across the view direction, world units
    normal,        ///< unit shading normal in world space, as shading uses it
    albedo,        ///< the diffuse colour, textures applied
    primitive_id,  ///< index in Scene::primitives
    instance_id,   ///< 0 in the world; instances count from 1, depth first in the order of the scene
    material_id,   ///< index in Scene::materials
};

constexpr std::uint32_t no_aov_id = 0xffffffff;

/// One AOV of an image, row-major from the top left: `values` with 1 (depth) or 3 interleaved floats
/// a pixel, or `ids`.
struct AovImage {
    Aov aov = Aov::depth;
    std::vector<float> values{};
    std::vector<std::uint32_t> ids{};
};

}  // namespace sahl
