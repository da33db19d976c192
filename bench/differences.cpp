#include "bench/differences.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "bench/exact_hit.h"

namespace sahl::bench {
namespace {

constexpr double tolerance = 1e-4;
constexpr double at_outline = 1e-5;

bool same_distance(double a, double b) { return std::abs(a - b) <= tolerance * std::abs(b); }

bool agree(const RayHit& a, const RayHit& b, bool occlusion) {
    if (a.hit != b.hit) return false;
    return !a.hit || occlusion || same_distance(static_cast<double>(a.t), static_cast<double>(b.t));
}

/// What four units in the last place of the coordinates come to along the ray.
double rounding_of(const ExactHit& hit, const glm::vec3& origin, const glm::vec3& direction) {
    const glm::dvec3 from(origin), along(direction);
    const glm::dvec3 reach = glm::max(glm::abs(from), glm::abs(from + hit.t * along));
    return 0x1p-22 * std::max({reach.x, reach.y, reach.z}) / std::abs(glm::dot(hit.normal, along));
}

}  // namespace

Differences& Differences::operator+=(const Differences& other) {
    sahl_misses += other.sahl_misses;
    embree_misses += other.embree_misses;
    distances += other.distances;
    at_outline += other.at_outline;
    rounding += other.rounding;
    sahl_right += other.sahl_right;
    embree_right += other.embree_right;
    both_wrong += other.both_wrong;
    return *this;
}

std::vector<std::size_t> differing_rays(const RaySet& rays, const std::vector<RayHit>& sahl,
                                        const std::vector<RayHit>& embree) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!agree(sahl[i], embree[i], rays.occlusion)) places.push_back(i);
    }
    return places;
}

void add_difference(Differences& differences, const Scene& scene, const RaySet& rays, std::size_t i,
                    const Answer& sahl, const Answer& embree) {
    ++(!sahl.hit.hit     ? differences.sahl_misses
       : !embree.hit.hit ? differences.embree_misses
                         : differences.distances);
    const glm::vec3 &origin = rays.origins[i], &direction = rays.directions[i];
    std::optional<ExactHit> truth;
    for (const RayHit& named : {sahl.named, embree.named}) {
        if (!named.hit) continue;
        if (outline_distance(scene, named.primitive, origin, direction) < at_outline) {
            ++differences.at_outline;
            return;
        }
        const double nearest = truth ? truth->t : static_cast<double>(rays.t_max);
        if (const auto hit = exact_hit(scene, named.primitive, origin, direction, nearest)) truth = hit;
    }
    const auto right = [&](const RayHit& hit) {
        if (hit.hit != truth.has_value()) return false;
        return !hit.hit || rays.occlusion || same_distance(static_cast<double>(hit.t), truth->t) ||
               std::abs(static_cast<double>(hit.t) - truth->t) <= rounding_of(*truth, origin, direction);
    };
    const bool sahl_right = right(sahl.hit), embree_right = right(embree.hit);
    ++(sahl_right && embree_right ? differences.rounding
       : sahl_right               ? differences.sahl_right
       : embree_right             ? differences.embree_right
                                  : differences.both_wrong);
}

}  // namespace sahl::bench
