#include "tests/support/oracle/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace sahl::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Twice the vector area (Newell), relative to the first corner.
dvec3 vector_area(const std::vector<dvec3>& points) {
    dvec3 area(0);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        area += glm::cross(points[i] - points[0], points[i + 1] - points[0]);
    }
    return area;
}

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

}  // namespace

Shape::Shape(const Scene& scene, const Primitive& primitive)
    : kind_(primitive.kind),
      identity_(scene.transforms[primitive.transform] == glm::dmat4(1)),
      sides_(primitive.sides) {
    const glm::dmat4& world_from_object = scene.transforms[primitive.transform];
    object_from_world_ = glm::inverse(world_from_object);
    normal_matrix_ = glm::transpose(glm::dmat3(object_from_world_));

    double reach = 0;  // around each of points_, in object space
    switch (kind_) {
        case PrimitiveKind::triangle: {
            const Triangle& triangle = scene.triangles[primitive.index];
            smooth_ = triangle.smooth;
            for (const std::uint32_t vertex : triangle.vertices) points_.emplace_back(scene.vertices[vertex]);
            if (smooth_) {
                for (const std::uint32_t normal : triangle.normals)
                    normals_.push_back(glm::normalize(dvec3(scene.normals[normal])));
            }
            plane_normal_ = glm::normalize(vector_area(points_));
            break;
        }
        case PrimitiveKind::polygon: {
            const Polygon& polygon = scene.polygons[primitive.index];
            for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
                points_.emplace_back(scene.polygon_vertices[polygon.first_vertex + i]);
            }
            plane_normal_ = glm::normalize(vector_area(points_));
            break;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene.spheres[primitive.index];
            points_ = {sphere.center};
            radii_[0] = sphere.radius;
            reach = sphere.radius;
            break;
        }
        case PrimitiveKind::cone: {
            const Cone& cone = scene.cones[primitive.index];
            points_ = {cone.base, cone.apex};
            radii_[0] = cone.base_radius;
            radii_[1] = cone.apex_radius;
            reach = std::max(cone.base_radius, cone.apex_radius);
            break;
        }
        case PrimitiveKind::disc:
        case PrimitiveKind::box:
            break;
    }

    std::vector<dvec3> world_points;
    for (const dvec3& point : points_) {
        world_points.emplace_back(world_from_object * glm::dvec4(point, 1));
        bound_center_ += world_points.back() / static_cast<double>(points_.size());
    }
    double stretch = 0;  // Frobenius norm: no vector grows by more
    for (int column = 0; column < 3; ++column)
        stretch += glm::dot(world_from_object[column], world_from_object[column]);
    for (const dvec3& point : world_points)
        bound_radius_ = std::max(bound_radius_, glm::distance(point, bound_center_));
    bound_radius_ =
        (bound_radius_ + reach * std::sqrt(stretch)) * (1 + 1e-9) + 1e-12 * glm::length(bound_center_);
}

bool Shape::may_cross(const Ray& ray) const {
    const dvec3 across = glm::cross(bound_center_ - ray.origin, ray.direction);
    return !(glm::dot(across, across) >
             bound_radius_ * bound_radius_ * glm::dot(ray.direction, ray.direction) * (1 + 1e-9));
}

Crossings Shape::cross(const Ray& world_ray, bool starts_here) const {
    const bool planar = kind_ == PrimitiveKind::triangle || kind_ == PrimitiveKind::polygon;
    if (planar && starts_here) return {};
    Ray ray = world_ray;
    if (!identity_) {
        ray.origin = dvec3(object_from_world_ * glm::dvec4(world_ray.origin, 1));
        ray.direction = glm::dmat3(object_from_world_) * world_ray.direction;
    }
    Crossings result;
    switch (kind_) {
        case PrimitiveKind::triangle:
            result = cross_triangle(ray);
            break;
        case PrimitiveKind::polygon:
            result = cross_polygon(ray);
            break;
        case PrimitiveKind::sphere:
            result = cross_sphere(ray, starts_here);
            break;
        case PrimitiveKind::cone:
            result = cross_cone(ray, starts_here);
            break;
        case PrimitiveKind::disc:
        case PrimitiveKind::box:
            break;
    }
    int kept = 0;
    for (int i = 0; i < result.count; ++i) {
        Crossing crossing = result.at[i];
        const bool from_behind = glm::dot(ray.direction, crossing.ng) > 0;
        if (sides_ == (from_behind ? Sides::front : Sides::back)) continue;
        crossing.ng = glm::normalize(normal_matrix_ * crossing.ng);
        crossing.ns = smooth_ ? glm::normalize(normal_matrix_ * crossing.ns) : crossing.ng;
        result.at[kept++] = crossing;
    }
    result.count = kept;
    return result;
}

// Plane, then barycentric coordinates by areas.
Crossings Shape::cross_triangle(const Ray& ray) const {
    Crossings result;
    const double across = glm::dot(plane_normal_, ray.direction);
    const double t = glm::dot(plane_normal_, points_[0] - ray.origin) / across;
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
    crossing = {t, plane_normal_, plane_normal_, {barycentrics[1], barycentrics[2]}};
    if (smooth_) {
        crossing.ns = dvec3(0);
        for (std::size_t i = 0; i < 3; ++i) crossing.ns += barycentrics[i] * normals_[i];
    }
    return result;
}

// Plane, then the winding number of the outline (Hormann, Agathos 2001).
Crossings Shape::cross_polygon(const Ray& ray) const {
    Crossings result;
    const double t =
        glm::dot(plane_normal_, points_[0] - ray.origin) / glm::dot(plane_normal_, ray.direction);
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
    if (winding != 0) result.at[result.count++] = {t, plane_normal_, plane_normal_, {}};
    return result;
}

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
        result.at[result.count++] = {roots[i], normal, normal, {}};
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
        result.at[result.count++] = {roots[i], normal, normal, {}};
    }
    return result;
}

}  // namespace sahl::oracle
