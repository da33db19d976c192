// Crossings with triangles, polygons, discs and boxes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/oracle/crossings.h"
#include "engine/oracle/shape.h"

namespace sahl::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Axes that stay when the largest component of `normal` is dropped.
void projection_axes(const dvec3& normal, int& first, int& second) {
    const dvec3 size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    first = (dropped + 1) % 3;
    second = (dropped + 2) % 3;
}

double cross_2d(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

double distance_to_segment(const dvec2& point, const dvec2& a, const dvec2& b) {
    const dvec2 edge = b - a;
    const double length_squared = glm::dot(edge, edge);
    const double s =
        length_squared > 0 ? std::clamp(glm::dot(point - a, edge) / length_squared, 0.0, 1.0) : 0;
    return glm::length(point - a - s * edge);
}

double plane_distance(const dvec3& normal, const dvec3& anchor, const Ray& ray) {
    return glm::dot(normal, anchor - ray.origin) / glm::dot(normal, ray.direction);
}

}  // namespace

// Plane, then barycentric coordinates by areas.
Crossings Shape::cross_triangle(const Ray& ray) const {
    Crossings result;
    const double t = plane_distance(plane_normal_, points_[0], ray);
    if (!std::isfinite(t)) return result;
    const dvec3 point = ray.origin + t * ray.direction;
    const dvec3 whole = glm::cross(points_[1] - points_[0], points_[2] - points_[0]);
    double barycentrics[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 part = glm::cross(points_[(i + 1) % 3] - point, points_[(i + 2) % 3] - point);
        barycentrics[i] = glm::dot(part, whole) / glm::dot(whole, whole);
    }
    const double least = std::min({barycentrics[0], barycentrics[1], barycentrics[2]});
    result.margin = std::abs(least);
    if (!(least >= 0)) return result;
    Crossing& crossing = result.at[result.count++];
    const dvec2 own(barycentrics[1], barycentrics[2]);
    crossing = {t, plane_normal_, plane_normal_, own, own, 0};
    if (has_uv_) {
        crossing.uv = dvec2(0);
        for (std::size_t i = 0; i < 3; ++i) crossing.uv += barycentrics[i] * uvs_[i];
    }
    if (smooth_) {
        crossing.ns = dvec3(0);
        for (std::size_t i = 0; i < 3; ++i) crossing.ns += barycentrics[i] * normals_[i];
    }
    return result;
}

// Plane, then the winding number of the outline (Hormann, Agathos 2001).
Crossings Shape::cross_polygon(const Ray& ray) const {
    Crossings result;
    const double t = plane_distance(plane_normal_, points_[0], ray);
    if (!std::isfinite(t)) return result;
    int first = 0;
    int second = 0;
    projection_axes(plane_normal_, first, second);
    const dvec3 spot = ray.origin + t * ray.direction;
    const dvec2 point(spot[first], spot[second]);
    int winding = 0;
    double nearest = std::numeric_limits<double>::infinity();
    double perimeter = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const dvec3& here = points_[i];
        const dvec3& next = points_[(i + 1) % points_.size()];
        const dvec2 a(here[first], here[second]);
        const dvec2 b(next[first], next[second]);
        const double side = cross_2d(b - a, point - a);
        if (a.y <= point.y && b.y > point.y && side > 0) ++winding;
        if (a.y > point.y && b.y <= point.y && side < 0) --winding;
        nearest = std::min(nearest, distance_to_segment(point, a, b));
        perimeter += glm::distance(a, b);
    }
    result.margin = nearest / perimeter;
    if (winding == 0) return result;
    const dvec3 along = glm::normalize(points_[1] - points_[0]);
    const dvec3 left = glm::cross(plane_normal_, along);
    const dvec2 uv(glm::dot(spot - points_[0], along), glm::dot(spot - points_[0], left));
    result.at[result.count++] = {t, plane_normal_, plane_normal_, uv, {}, 0};
    return result;
}

Crossings Shape::cross_disc(const Ray& ray) const {
    Crossings result;
    const double t = plane_distance(plane_normal_, points_[0], ray);
    if (!std::isfinite(t)) return result;
    const dvec3 from_center = ray.origin + t * ray.direction - points_[0];
    const double share = glm::length(from_center) / radii_[0];
    result.margin = std::abs(share - 1);
    if (share <= 1) {
        const dvec2 uv(turn_about(plane_normal_, from_center), share);
        result.at[result.count++] = {t, plane_normal_, plane_normal_, uv, {}, 0};
    }
    return result;
}

// Six rectangles.
Crossings Shape::cross_box(const Ray& ray, bool starts_here) const {
    Candidates candidates;
    double margin = std::numeric_limits<double>::infinity();
    const dvec3 size = points_[1] - points_[0];
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const bool high = face % 2 == 1;
        const double t = (points_[high ? 1 : 0][axis] - ray.origin[axis]) / ray.direction[axis];
        if (!std::isfinite(t)) continue;
        const dvec3 share = (ray.origin + t * ray.direction - points_[0]) / size;
        const int first = axis == 0 ? 1 : 0;
        const int second = axis == 2 ? 1 : 2;
        const double beyond = std::max(std::abs(share[first] - 0.5), std::abs(share[second] - 0.5)) - 0.5;
        margin = std::min(margin, std::abs(beyond));
        if (beyond > 0) continue;
        dvec3 normal(0);
        normal[axis] = high ? 1 : -1;
        candidates.push_back({t, normal, normal, {share[first], share[second]}, {}, face});
    }
    return solid_crossings(candidates, margin, starts_here);
}

}  // namespace sahl::oracle
