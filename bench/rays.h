// The rays that both sides trace, and what they say of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::bench {

/// Camera rays, and what follows them from where they end.
inline constexpr std::array ray_kinds{"primary", "shadow", "diffuse", "mirror", "refracted"};

/// Rays 0 < t < t_max. `occlusion`: asked is only whether they meet anything.
struct RaySet {
    std::string kind;  ///< of ray_kinds
    bool occlusion = false;
    float t_max = 0;
    std::vector<glm::vec3> origins, directions;

    std::size_t size() const { return origins.size(); }
};

/// The rays at `places` alone.
RaySet select_rays(const RaySet& rays, std::span<const std::size_t> places);

/// What one ray met: of an occlusion ray `t` and `primitive` mean nothing.
struct RayHit {
    bool hit = false;
    float t = 0;
    std::uint32_t primitive = 0;  ///< index in Scene::primitives
};

/// Where a camera ray ended.
struct SurfacePoint {
    glm::dvec3 position;
    glm::dvec3 normal;    ///< unit, on the ray's side
    glm::dvec3 incoming;  ///< the ray's unit direction
};

/// One ray through each pixel's centre of size × size, in the order in which the engine numbers pixels
/// (kernels/camera.h). `size`: a multiple of 8.
RaySet primary_rays(const Camera& camera, int size);

/// The points that `rays` hit, in their order, in double precision; misses and hits that pass by the
/// primitive when rounded less are left out.
std::vector<SurfacePoint> surface_points(const Scene& scene, const RaySet& rays,
                                         const std::vector<RayHit>& hits);

/// From the points to a light: t_max 1 is the light's distance.
RaySet shadow_rays(const std::vector<SurfacePoint>& points, const Light& light);
/// By the cosine, one a point.
RaySet diffuse_rays(const std::vector<SurfacePoint>& points);
RaySet mirror_rays(const std::vector<SurfacePoint>& points);
/// Into glass of index 1.5.
RaySet refracted_rays(const std::vector<SurfacePoint>& points);

}  // namespace sahl::bench
