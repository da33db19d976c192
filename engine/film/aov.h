// Arbitrary output variables: what the renderer knows of the first surface behind each pixel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sahl {

/// Of sample 0 of a pixel, at the first hit; where there is none: depth infinite, normal and albedo 0, ids
/// `no_aov_id`. Or what a pixel costs, all its samples and generations together (is_cost).
enum class Aov {
    depth,         ///< distance from the plane through the eye across the view direction, world units
    normal,        ///< unit shading normal in world space, as shading uses it
    albedo,        ///< the diffuse colour, textures applied
    primitive_id,  ///< index in Scene::primitives
    instance_id,   ///< 0 in the world; instances count from 1, depth first in the order of the scene
    material_id,   ///< index in Scene::materials
    cost_rays,     ///< rays and shadow rays that were traced for the pixel
    cost_nodes,    ///< nodes of the trees that they opened, going one by one
};

/// Names on the command line and in EXR files, where each component is a channel: `Z`,
/// `N.X`, `albedo.R`, …
struct AovName {
    Aov aov;
    std::string_view name;
    std::string_view components;  ///< a letter each, after a dot; empty: one channel of that name
    bool is_uint;                 ///< ids and counts
};

inline constexpr std::array aov_names{
    AovName{Aov::depth, "Z", "", false},
    AovName{Aov::normal, "N", "XYZ", false},
    AovName{Aov::albedo, "albedo", "RGB", false},
    AovName{Aov::primitive_id, "id.primitive", "", true},
    AovName{Aov::instance_id, "id.instance", "", true},
    AovName{Aov::material_id, "id.material", "", true},
    AovName{Aov::cost_rays, "cost.rays", "", true},
    AovName{Aov::cost_nodes, "cost.nodes", "", true},
};

constexpr const AovName& aov_name(Aov aov) { return aov_names[static_cast<std::size_t>(aov)]; }

/// Takes a render of its own, which counts, and is another with each depth and number of samples.
constexpr bool is_cost(Aov aov) { return aov == Aov::cost_rays || aov == Aov::cost_nodes; }

/// What "all" AOVs are to users: not costs, which take another render.
inline std::vector<Aov> aovs_of_first_hits() {
    std::vector<Aov> aovs;
    for (const AovName& name : aov_names) {
        if (!is_cost(name.aov)) aovs.push_back(name.aov);
    }
    return aovs;
}

/// Bytes of a pixel in an AovImage.
constexpr std::uint64_t aov_pixel_bytes(Aov aov) {
    const std::size_t components = aov_name(aov).components.size();
    return sizeof(float) * (components > 0 ? components : 1);
}

constexpr std::uint32_t no_aov_id = 0xffffffff;

/// One AOV of an image, row-major from the top left: `values` with 1 (depth) or 3 interleaved floats
/// a pixel, or `uints`.
struct AovImage {
    Aov aov = Aov::depth;
    std::vector<float> values{};
    std::vector<std::uint32_t> uints{};
};

}  // namespace sahl
