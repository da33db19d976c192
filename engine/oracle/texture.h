// Procedural colours of the oracle.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::oracle {

/// `color` times texture `index` of the scene, or as it is with no_texture. What of it jumps with the
/// place is mixed into `decisions`.
glm::dvec3 textured(const Scene& scene, const glm::vec3& color, std::uint32_t index,
                    const glm::dvec3& position, const glm::dvec2& uv, std::uint64_t& decisions);

}  // namespace sahl::oracle
