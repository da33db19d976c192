#include "bench/rays.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "bench/all_cores.h"
#include "bench/exact_hit.h"
#include "bench/noise.h"

namespace sahl::bench {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// How far off the surface rays start. The engine leaves out what they start on instead, which Embree cannot:
/// here both sides have to get the same rays.
constexpr double lift = 1e-4;

RaySet make_rays(const char* kind, std::size_t count) {
    RaySet rays{kind, false, infinity, {}, {}};
    rays.origins.reserve(count);
    rays.directions.reserve(count);
    return rays;
}

void add_ray(RaySet& rays, const glm::dvec3& origin, const glm::dvec3& direction) {
    rays.origins.emplace_back(origin);
    rays.directions.emplace_back(direction);
}

}  // namespace

RaySet select_rays(const RaySet& rays, std::span<const std::size_t> places) {
    RaySet selected{rays.kind, rays.occlusion, rays.t_max, {}, {}};
    for (const std::size_t place : places) {
        selected.origins.push_back(rays.origins[place]);
        selected.directions.push_back(rays.directions[place]);
    }
    return selected;
}

RaySet primary_rays(const Camera& camera, int size) {
    constexpr int strip_height = 8, block_columns = 4;
    const glm::dvec3 forward = glm::normalize(camera.look_at - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::dvec3 down = glm::cross(forward, right);
    const double reach = std::tan(glm::radians(camera.fov_y) / 2);
    const auto across = [&](int pixel) { return reach * (2 * (pixel + 0.5) / size - 1); };
    RaySet rays = make_rays("primary", static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int top = 0; top < size; top += strip_height) {
        for (int left = 0; left < size; left += block_columns) {
            for (int y = top; y < top + strip_height; ++y) {
                for (int x = left; x < left + block_columns; ++x)
                    add_ray(rays, camera.eye, glm::normalize(forward + across(x) * right + across(y) * down));
            }
        }
    }
    return rays;
}

std::vector<SurfacePoint> surface_points(const Scene& scene, const RaySet& rays,
                                         const std::vector<RayHit>& hits) {
    std::vector<std::optional<SurfacePoint>> found(rays.size());
    for_chunks(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!hits[i].hit) continue;
            const auto crossing =
                exact_hit(scene, hits[i].primitive, rays.origins[i], rays.directions[i], infinity);
            if (!crossing) continue;
            const glm::dvec3 direction(rays.directions[i]);
            const bool away = glm::dot(crossing->normal, direction) > 0;
            found[i] = {glm::dvec3(rays.origins[i]) + crossing->t * direction,
                        away ? -crossing->normal : crossing->normal, glm::normalize(direction)};
        }
    });
    std::vector<SurfacePoint> points;
    points.reserve(rays.size());
    for (const auto& point : found) {
        if (point) points.push_back(*point);
    }
    return points;
}

RaySet shadow_rays(const std::vector<SurfacePoint>& points, const Light& light) {
    RaySet rays = make_rays("shadow", points.size());
    rays.occlusion = true;
    rays.t_max = 1;
    for (const SurfacePoint& point : points) {
        const glm::dvec3 origin = point.position + lift * point.normal;
        add_ray(rays, origin, light.position - origin);
    }
    return rays;
}

RaySet diffuse_rays(const std::vector<SurfacePoint>& points) {
    RaySet rays = make_rays("diffuse", points.size());
    for (const SurfacePoint& point : points) {
        const auto i = static_cast<std::uint32_t>(rays.size());
        // Unit sphere around the normal's tip (Shirley, Ray Tracing Gems ch. 16.6.2).
        const double z = 1 - 2 * static_cast<double>(uniform(i, 100));
        const double angle = 2 * std::numbers::pi * static_cast<double>(uniform(i, 101));
        const double radius = std::sqrt(1 - z * z);
        const glm::dvec3 on_sphere(radius * std::cos(angle), radius * std::sin(angle), z);
        // Never 0, should both cancel.
        add_ray(rays, point.position + lift * point.normal,
                glm::normalize(1.000001 * point.normal + on_sphere));
    }
    return rays;
}

RaySet mirror_rays(const std::vector<SurfacePoint>& points) {
    RaySet rays = make_rays("mirror", points.size());
    for (const SurfacePoint& point : points)
        add_ray(rays, point.position + lift * point.normal, glm::reflect(point.incoming, point.normal));
    return rays;
}

RaySet refracted_rays(const std::vector<SurfacePoint>& points) {
    RaySet rays = make_rays("refracted", points.size());
    for (const SurfacePoint& point : points)
        add_ray(rays, point.position - lift * point.normal,
                glm::refract(point.incoming, point.normal, 1 / 1.5));
    return rays;
}

}  // namespace sahl::bench
