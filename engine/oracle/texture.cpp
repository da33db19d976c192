#include "engine/oracle/texture.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace sahl::oracle {

using glm::dvec3;

glm::dvec3 textured(const Scene& scene, const glm::vec3& color, std::uint32_t index, const dvec3& position,
                    const glm::dvec2& uv, std::uint64_t& decisions) {
    if (index == no_texture) return dvec3(color);
    const Texture& texture = scene.textures[index];
    const bool by_uv = texture.space == TextureSpace::uv;
    const dvec3 place = (by_uv ? dvec3(uv, 0) : position) - texture.origin;
    if (texture.pattern == Pattern::checker) {
        std::int64_t sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (texture.extent[axis] != 0)
                sum += static_cast<std::int64_t>(std::floor(place[axis] / texture.extent[axis]));
        }
        decisions = 2 * decisions + (sum % 2 != 0 ? 1 : 0);
        return dvec3(color) * dvec3(texture.colors[sum % 2 != 0 ? 1 : 0]);
    }
    // Angles jump from 1 to 0 somewhere.
    if (by_uv) decisions = 2 * decisions + (uv.x < 0.5 ? 1 : 0);
    const double share =
        std::clamp(glm::dot(place, texture.extent) / glm::dot(texture.extent, texture.extent), 0.0, 1.0);
    return dvec3(color) * glm::mix(dvec3(texture.colors[0]), dvec3(texture.colors[1]), share);
}

}  // namespace sahl::oracle
