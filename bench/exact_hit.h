// A ray and one primitive in double precision, by the engine's oracle.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::bench {

struct ExactHit {
    double t;
    glm::dvec3 normal;  ///< unit, front or outward
};

/// The first crossing at 0 < t < t_max of the ray with primitive `primitive` alone.
std::optional<ExactHit> exact_hit(const Scene& scene, std::uint32_t primitive, const glm::vec3& origin,
                                  const glm::vec3& direction, double t_max);

/// How far the ray's line is from the primitive's outline, in units of the primitive: rounding to single
/// precision may decide where it is next to nothing.
double outline_distance(const Scene& scene, std::uint32_t primitive, const glm::vec3& origin,
                        const glm::vec3& direction);

}  // namespace sahl::bench
