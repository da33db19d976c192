#include "engine/oracle/shape.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace sahl::oracle {
namespace {

using glm::dvec3;

/// Twice the vector area (Newell), relative to the first corner.
dvec3 vector_area(const std::vector<dvec3>& points) {
    dvec3 area(0);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        area += glm::cross(points[i] - points[0], points[i + 1] - points[0]);
    }
    return area;
}

/// Calls visit(instance's world-from-group matrix, its group) for the instances of a list and those
/// within, each before its own.
template <class Visit>
void for_each_instance(const Scene& scene, const std::vector<Instance>& instances,
                       const glm::dmat4& world_from_space, const Visit& visit) {
    for (const Instance& instance : instances) {
        const Group& group = scene.groups[instance.group];
        const glm::dmat4 world_from_group = world_from_space * scene.transforms[instance.transform];
        visit(world_from_group, group);
        for_each_instance(scene, group.instances, world_from_group, visit);
    }
}

}  // namespace

Shape::Shape(const Scene& scene, const Primitive& primitive, const glm::dmat4& world_from_space)
    : kind_(primitive.kind), sides_(primitive.sides) {
    const glm::dmat4 world_from_object = world_from_space * scene.transforms[primitive.transform];
    identity_ = world_from_object == glm::dmat4(1);
    object_from_world_ = glm::inverse(world_from_object);
    normal_matrix_ = glm::transpose(glm::dmat3(object_from_world_));

    double reach = 0;  // around each of points_, in object space
    switch (kind_) {
        case PrimitiveKind::triangle: {
            const Triangle& triangle = scene.triangles[primitive.index];
            smooth_ = triangle.smooth;
            has_uv_ = triangle.has_uv;
            for (std::size_t i = 0; i < 3; ++i) {
                points_.emplace_back(scene.vertices[triangle.vertices[i]]);
                if (smooth_) normals_.push_back(glm::normalize(dvec3(scene.normals[triangle.normals[i]])));
                if (has_uv_) uvs_.emplace_back(scene.uvs[triangle.uvs[i]]);
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
            solid_ = cone.capped;
            reach = std::max(cone.base_radius, cone.apex_radius);
            break;
        }
        case PrimitiveKind::disc: {
            const Disc& disc = scene.discs[primitive.index];
            points_ = {disc.center};
            radii_[0] = disc.radius;
            plane_normal_ = glm::normalize(disc.normal);
            reach = disc.radius;
            break;
        }
        case PrimitiveKind::box: {
            const Box& box = scene.boxes[primitive.index];
            points_ = {box.lo, box.hi};
            reach = glm::distance(box.lo, box.hi) / 2;
            break;
        }
    }
    find_bound(world_from_object, reach);
}

void Shape::find_bound(const glm::dmat4& world_from_object, double reach) {
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
    Ray ray = world_ray;
    if (!identity_) {
        ray.origin = dvec3(object_from_world_ * glm::dvec4(world_ray.origin, 1));
        ray.direction = glm::dmat3(object_from_world_) * world_ray.direction;
    }
    Crossings result = cross_in_object_space(ray, starts_here);
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

Crossings Shape::cross_in_object_space(const Ray& ray, bool starts_here) const {
    switch (kind_) {
        case PrimitiveKind::triangle:
            return starts_here ? Crossings{} : cross_triangle(ray);
        case PrimitiveKind::polygon:
            return starts_here ? Crossings{} : cross_polygon(ray);
        case PrimitiveKind::disc:
            return starts_here ? Crossings{} : cross_disc(ray);
        case PrimitiveKind::sphere:
            return cross_sphere(ray, starts_here);
        case PrimitiveKind::cone:
            return solid_ ? cross_solid_cone(ray, starts_here) : cross_cone(ray, starts_here);
        case PrimitiveKind::box:
            return cross_box(ray, starts_here);
    }
    return {};
}

std::vector<PlacedShape> place_shapes(const Scene& scene) {
    std::vector<PlacedShape> shapes;
    std::uint32_t number = 0;
    const auto add = [&](const glm::dmat4& placement, std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t id = first; id < first + count; ++id)
            shapes.push_back({Shape(scene, scene.primitives[id], placement), id, number});
    };
    add(glm::dmat4(1), 0, world_primitive_count(scene));
    for_each_instance(scene, scene.instances, glm::dmat4(1),
                      [&](const glm::dmat4& placement, const Group& group) {
                          ++number;
                          add(placement, group.first_primitive, group.primitive_count);
                      });
    return shapes;
}

std::vector<glm::dmat4> instance_placements(const Scene& scene) {
    std::vector<glm::dmat4> placements;
    for_each_instance(scene, scene.instances, glm::dmat4(1),
                      [&](const glm::dmat4& placement, const Group&) { placements.push_back(placement); });
    return placements;
}

}  // namespace sahl::oracle
