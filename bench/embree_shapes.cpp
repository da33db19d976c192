#include "bench/embree_shapes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace sahl::bench {
namespace {

struct UserRay {
    glm::vec3 origin, direction;
    float t_min, t_max;

    bool reaches(float t) const { return t > t_min && t < t_max; }
};

struct UserHit {
    float t;
    glm::vec3 normal;
};

struct UserSphere {
    glm::vec3 center;
    float radius;
};

/// x² + y² = (radius + slope z)², 0 <= z <= height, along `axis` from `base`.
struct UserCone {
    glm::vec3 base, axis;
    float height, radius, slope;
};

/// A range of the corners, projected along the axis of the normal's largest component.
struct UserPolygon {
    glm::vec3 normal;
    float offset;
    int x_axis, y_axis;
    std::uint32_t first, count;
    glm::vec3 lo, hi;
};

}  // namespace

struct UserShapes {
    std::vector<UserSphere> spheres;
    std::vector<UserCone> cones;
    std::vector<UserPolygon> polygons;
    std::vector<glm::vec2> corners;
};

void UserShapesDelete::operator()(UserShapes* shapes) const { delete shapes; }

namespace {

// ---- Intersection: false or the first hit within the ray's range -----------------------------

/// Where the ray is nearest to `center`: quadratics are solved from there, or they lose all digits.
float nearest_approach(const UserRay& ray, glm::vec3 center) {
    return glm::dot(center - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
}

bool intersect_sphere(const UserShapes& shapes, std::uint32_t index, const UserRay& ray, UserHit& hit) {
    const UserSphere& sphere = shapes.spheres[index];
    const float t = nearest_approach(ray, sphere.center);
    const glm::vec3 off = ray.origin + t * ray.direction - sphere.center;
    const float under_root = sphere.radius * sphere.radius - glm::dot(off, off);
    if (under_root < 0) return false;
    const float half = std::sqrt(under_root / glm::dot(ray.direction, ray.direction));
    hit.t = ray.reaches(t - half) ? t - half : t + half;
    if (!ray.reaches(hit.t)) return false;
    hit.normal = ray.origin + hit.t * ray.direction - sphere.center;
    return true;
}

bool intersect_cone(const UserShapes& shapes, std::uint32_t index, const UserRay& ray, UserHit& hit) {
    const UserCone& cone = shapes.cones[index];
    const float start = nearest_approach(ray, cone.base + cone.axis * (cone.height / 2));
    const glm::vec3 from = ray.origin + start * ray.direction - cone.base;
    const float z = glm::dot(from, cone.axis), dz = glm::dot(ray.direction, cone.axis);
    const float radius = cone.radius + cone.slope * z, dr = cone.slope * dz;
    const float a = glm::dot(ray.direction, ray.direction) - dz * dz - dr * dr;
    const float b = glm::dot(from, ray.direction) - z * dz - radius * dr;
    const float c = glm::dot(from, from) - z * z - radius * radius;
    const float under_root = b * b - a * c;
    if (under_root < 0) return false;
    const float root = std::copysign(std::sqrt(under_root), b);
    const float one = -(b + root) / a, other = -c / (b + root);
    for (const float t : {std::min(one, other), std::max(one, other)}) {
        const float height = z + t * dz;
        if (!ray.reaches(start + t) || height < 0 || height > cone.height) continue;
        hit.t = start + t;
        hit.normal = from + t * ray.direction - cone.axis * (height + cone.slope * (radius + t * dr));
        return true;
    }
    return false;
}

bool intersect_polygon(const UserShapes& shapes, std::uint32_t index, const UserRay& ray, UserHit& hit) {
    const UserPolygon& polygon = shapes.polygons[index];
    hit.t = (polygon.offset - glm::dot(polygon.normal, ray.origin)) / glm::dot(polygon.normal, ray.direction);
    if (!ray.reaches(hit.t)) return false;
    const glm::vec3 place = ray.origin + hit.t * ray.direction;
    const glm::vec2 p(place[polygon.x_axis], place[polygon.y_axis]);
    bool inside = false;
    glm::vec2 a = shapes.corners[polygon.first + polygon.count - 1];
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const glm::vec2 b = shapes.corners[polygon.first + i];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
        a = b;
    }
    hit.normal = polygon.normal;
    return inside;
}

// ---- Bounds ----------------------------------------------------------------------------------

struct UserBounds {
    glm::vec3 lo, hi;
};

UserBounds bounds_of_sphere(const UserShapes& shapes, std::uint32_t index) {
    const UserSphere& sphere = shapes.spheres[index];
    return {sphere.center - sphere.radius, sphere.center + sphere.radius};
}

UserBounds bounds_of_cone(const UserShapes& shapes, std::uint32_t index) {
    const UserCone& cone = shapes.cones[index];
    const glm::vec3 apex = cone.base + cone.height * cone.axis;
    const glm::vec3 spread = glm::sqrt(glm::max(1.0F - cone.axis * cone.axis, 0.0F));
    const glm::vec3 at_base = cone.radius * spread;
    const glm::vec3 at_apex = (cone.radius + cone.slope * cone.height) * spread;
    return {glm::min(cone.base - at_base, apex - at_apex), glm::max(cone.base + at_base, apex + at_apex)};
}

UserBounds bounds_of_polygon(const UserShapes& shapes, std::uint32_t index) {
    return {shapes.polygons[index].lo, shapes.polygons[index].hi};
}

// ---- Embree's callbacks ----------------------------------------------------------------------

UserRay load_ray(RTCRayN* rays, unsigned int width, unsigned int lane) {
    return {{RTCRayN_org_x(rays, width, lane), RTCRayN_org_y(rays, width, lane),
             RTCRayN_org_z(rays, width, lane)},
            {RTCRayN_dir_x(rays, width, lane), RTCRayN_dir_y(rays, width, lane),
             RTCRayN_dir_z(rays, width, lane)},
            RTCRayN_tnear(rays, width, lane),
            RTCRayN_tfar(rays, width, lane)};
}

template <auto bounds_of>
void report_bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* shapes = static_cast<const UserShapes*>(arguments->geometryUserPtr);
    const UserBounds bounds = bounds_of(*shapes, arguments->primID);
    *arguments->bounds_o = {bounds.lo.x, bounds.lo.y, bounds.lo.z, 0,
                            bounds.hi.x, bounds.hi.y, bounds.hi.z, 0};
}

template <auto intersect>
void find_closest(const RTCIntersectFunctionNArguments* arguments) {
    const auto* shapes = static_cast<const UserShapes*>(arguments->geometryUserPtr);
    const unsigned int width = arguments->N;
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, width);
    RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, width);
    for (unsigned int lane = 0; lane < width; ++lane) {
        UserHit hit;
        if (arguments->valid[lane] == 0 ||
            !intersect(*shapes, arguments->primID, load_ray(rays, width, lane), hit))
            continue;
        RTCRayN_tfar(rays, width, lane) = hit.t;
        RTCHitN_Ng_x(hits, width, lane) = hit.normal.x;
        RTCHitN_Ng_y(hits, width, lane) = hit.normal.y;
        RTCHitN_Ng_z(hits, width, lane) = hit.normal.z;
        RTCHitN_u(hits, width, lane) = 0;
        RTCHitN_v(hits, width, lane) = 0;
        RTCHitN_primID(hits, width, lane) = arguments->primID;
        RTCHitN_geomID(hits, width, lane) = arguments->geomID;
        RTCHitN_instID(hits, width, lane, 0) = arguments->context->instID[0];
    }
}

template <auto intersect>
void find_any(const RTCOccludedFunctionNArguments* arguments) {
    const auto* shapes = static_cast<const UserShapes*>(arguments->geometryUserPtr);
    for (unsigned int lane = 0; lane < arguments->N; ++lane) {
        UserHit hit;
        if (arguments->valid[lane] != 0 &&
            intersect(*shapes, arguments->primID, load_ray(arguments->ray, arguments->N, lane), hit))
            RTCRayN_tfar(arguments->ray, arguments->N, lane) = -INFINITY;
    }
}

template <auto intersect, auto bounds_of>
void set_functions(RTCGeometry geometry, std::size_t count) {
    if (count == 0) return;
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(count));
    rtcSetGeometryBoundsFunction(geometry, report_bounds<bounds_of>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, find_closest<intersect>);
    rtcSetGeometryOccludedFunction(geometry, find_any<intersect>);
}

// ---- From the scene --------------------------------------------------------------------------

UserCone user_cone(const Cone& cone) {
    const glm::dvec3 along = cone.apex - cone.base;
    const double height = glm::length(along);
    return {glm::vec3(cone.base), glm::vec3(along / height), static_cast<float>(height),
            static_cast<float>(cone.base_radius),
            static_cast<float>((cone.apex_radius - cone.base_radius) / height)};
}

UserPolygon user_polygon(const Scene& scene, const Polygon& polygon, std::vector<glm::vec2>& corners) {
    const glm::vec3* points = scene.polygon_vertices.data() + polygon.first_vertex;
    glm::vec3 area(0), lo = points[0], hi = points[0];
    for (std::uint32_t i = 1; i < polygon.vertex_count; ++i) {
        area += glm::cross(points[i - 1] - points[0], points[i] - points[0]);
        lo = glm::min(lo, points[i]);
        hi = glm::max(hi, points[i]);
    }
    const glm::vec3 normal = glm::normalize(area), size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const UserPolygon result{normal,
                             glm::dot(normal, points[0]),
                             (dropped + 1) % 3,
                             (dropped + 2) % 3,
                             static_cast<std::uint32_t>(corners.size()),
                             polygon.vertex_count,
                             lo,
                             hi};
    for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
        corners.emplace_back(points[i][result.x_axis], points[i][result.y_axis]);
    return result;
}

}  // namespace

EmbreeGeometry embree_spheres(RTCDevice device, const Scene& scene) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
    auto* spheres = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                    RTC_FORMAT_FLOAT4, sizeof(glm::vec4),
                                                                    scene.spheres.size()));
    check_embree(device, "making buffers");
    for (const Sphere& sphere : scene.spheres)
        *spheres++ = glm::vec4(glm::dvec4(sphere.center, sphere.radius));
    rtcCommitGeometry(geometry.get());
    check_embree(device, "making spheres");
    return geometry;
}

OwnedUserShapes user_shapes(const Scene& scene) {
    OwnedUserShapes shapes(new UserShapes);
    for (const Sphere& sphere : scene.spheres)
        shapes->spheres.push_back({glm::vec3(sphere.center), static_cast<float>(sphere.radius)});
    for (const Cone& cone : scene.cones) shapes->cones.push_back(user_cone(cone));
    for (const Polygon& polygon : scene.polygons)
        shapes->polygons.push_back(user_polygon(scene, polygon, shapes->corners));
    return shapes;
}

EmbreeGeometry embree_user_geometry(RTCDevice device, UserShapes& shapes) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserData(geometry.get(), &shapes);
    set_functions<intersect_sphere, bounds_of_sphere>(geometry.get(), shapes.spheres.size());
    set_functions<intersect_cone, bounds_of_cone>(geometry.get(), shapes.cones.size());
    set_functions<intersect_polygon, bounds_of_polygon>(geometry.get(), shapes.polygons.size());
    rtcCommitGeometry(geometry.get());
    check_embree(device, "making a user geometry");
    return geometry;
}

}  // namespace sahl::bench
