// Crossings with spheres, cones and cylinders.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/oracle/crossings.h"
#include "engine/oracle/shape.h"

namespace sahl::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Real roots of a t² + 2 b t + c = 0 in long double; false if there are none. A root that does
/// not exist because a = 0 is infinite.
bool solve(long double a, long double b, long double c, double roots[2]) {
    const long double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return false;
    const long double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const double infinity = std::numeric_limits<double>::infinity();
    roots[0] = a != 0 ? static_cast<double>(q / a) : infinity;
    roots[1] = q != 0 ? static_cast<double>(c / q) : roots[0];
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    return true;
}

/// Index of the root at the origin of a ray that starts on the surface.
int nearest_to_zero(const double roots[2]) { return std::abs(roots[0]) <= std::abs(roots[1]) ? 0 : 1; }

/// About z from x, and from -z to z.
dvec2 sphere_uv(const dvec3& unit) {
    const double turn = std::atan2(unit.y, unit.x) / (2 * std::numbers::pi);
    return {turn < 0 ? turn + 1 : turn,
            0.5 + std::atan2(unit.z, std::hypot(unit.x, unit.y)) / std::numbers::pi};
}

}  // namespace

Crossings Shape::cross_sphere(const Ray& ray, bool starts_here) const {
    Crossings result;
    const dvec3 from_center = ray.origin - points_[0];
    const double length_squared = glm::dot(ray.direction, ray.direction);
    const dvec3 across = glm::cross(from_center, ray.direction);
    result.margin = std::abs(std::sqrt(glm::dot(across, across) / length_squared) / radii_[0] - 1);
    double roots[2];
    long double c = -static_cast<long double>(radii_[0]) * radii_[0];
    for (int axis = 0; axis < 3; ++axis) c += static_cast<long double>(from_center[axis]) * from_center[axis];
    if (!solve(length_squared, glm::dot(from_center, ray.direction), c, roots)) return result;
    const int dropped = starts_here ? nearest_to_zero(roots) : -1;
    for (int i = 0; i < 2; ++i) {
        if (i == dropped) continue;
        const dvec3 normal = glm::normalize(from_center + roots[i] * ray.direction);
        result.at[result.count++] = {roots[i], normal, normal, sphere_uv(normal), {}, 0};
    }
    return result;
}

// |q|² − z² = (r0 + k z)², z the height of q over the base along the axis, 0 <= z <= height.
Crossings Shape::cross_cone(const Ray& ray, bool starts_here) const {
    Crossings result;
    const double height = glm::distance(points_[0], points_[1]);
    const dvec3 axis = (points_[1] - points_[0]) / height;
    const double slope = (radii_[1] - radii_[0]) / height;
    const dvec3 from_base = ray.origin - points_[0];
    const double origin_z = glm::dot(from_base, axis);
    const double step_z = glm::dot(ray.direction, axis);
    const dvec3 origin_across = from_base - origin_z * axis;
    const dvec3 step_across = ray.direction - step_z * axis;
    const double origin_radius = radii_[0] + slope * origin_z;
    const double step_radius = slope * step_z;

    const double a = glm::dot(step_across, step_across) - step_radius * step_radius;
    const double b = glm::dot(origin_across, step_across) - origin_radius * step_radius;
    const double c = glm::dot(origin_across, origin_across) - origin_radius * origin_radius;
    const double size = std::max(std::abs(b * b), std::abs(a * c));
    result.margin = size > 0 ? std::abs(b * b - a * c) / size : 0;
    double roots[2];
    if (!solve(a, b, c, roots)) return result;
    const int dropped = starts_here ? nearest_to_zero(roots) : -1;
    for (int i = 0; i < 2; ++i) {
        if (i == dropped || !std::isfinite(roots[i])) continue;
        const double z = origin_z + roots[i] * step_z;
        const double radius = origin_radius + roots[i] * step_radius;
        result.margin = std::min({result.margin, std::abs(z) / height, std::abs(z - height) / height});
        if (!(z >= 0 && z <= height && radius >= 0)) continue;
        const dvec3 across = origin_across + roots[i] * step_across;
        const dvec3 normal = glm::normalize(across - slope * radius * axis);
        result.at[result.count++] = {roots[i], normal, normal, {turn_about(axis, across), z / height}, {}, 0};
    }
    return result;
}

// The open cone and a disc at either end.
Crossings Shape::cross_solid_cone(const Ray& ray, bool starts_here) const {
    const Crossings side = cross_cone(ray, false);
    Candidates candidates(side.at, side.at + side.count);
    double margin = side.margin;
    const dvec3 axis = glm::normalize(points_[1] - points_[0]);
    const double widest = std::max(radii_[0], radii_[1]);
    for (int end = 0; end < 2; ++end) {
        const dvec3& center = points_[static_cast<std::size_t>(end)];
        const double t = glm::dot(axis, center - ray.origin) / glm::dot(axis, ray.direction);
        if (!std::isfinite(t)) continue;
        const dvec3 across = ray.origin + t * ray.direction - center;
        const double distance = glm::length(across);
        margin = std::min(margin, std::abs(distance - radii_[end]) / widest);
        if (distance > radii_[end] || radii_[end] == 0) continue;
        const dvec3 normal = end == 0 ? -axis : axis;
        const dvec2 uv(turn_about(axis, across), end);
        candidates.push_back({t, normal, normal, uv, {}, 1 + end});
    }
    return solid_crossings(candidates, margin, starts_here);
}

}  // namespace sahl::oracle
