#include "bench/exact_hit.h"

#include "engine/oracle/shape.h"

namespace sahl::bench {
namespace {

oracle::Crossings crossings(const Scene& scene, std::uint32_t primitive, const glm::vec3& origin,
                            const glm::vec3& direction) {
    return oracle::Shape(scene, scene.primitives[primitive])
        .cross({glm::dvec3(origin), glm::dvec3(direction)}, false);
}

}  // namespace

std::optional<ExactHit> exact_hit(const Scene& scene, std::uint32_t primitive, const glm::vec3& origin,
                                  const glm::vec3& direction, double t_max) {
    const oracle::Crossings found = crossings(scene, primitive, origin, direction);
    std::optional<ExactHit> first;
    for (int i = 0; i < found.count; ++i) {
        const oracle::Crossing& crossing = found.at[i];
        if (crossing.t > 0 && crossing.t < (first ? first->t : t_max)) first = {crossing.t, crossing.ng};
    }
    return first;
}

double outline_distance(const Scene& scene, std::uint32_t primitive, const glm::vec3& origin,
                        const glm::vec3& direction) {
    return crossings(scene, primitive, origin, direction).margin;
}

}  // namespace sahl::bench
