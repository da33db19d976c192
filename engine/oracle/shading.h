// Light at a hit and what it sends on, from the formulas of engine/scene/scene.h.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "engine/oracle/oracle.h"
#include "engine/scene/scene.h"

namespace sahl::oracle {

/// A material's colours where a hit is, its textures applied.
struct SurfaceColors {
    glm::dvec3 ambient, diffuse, specular, emission, reflection;
};

/// What of the textures jumps with the place is mixed into `decisions`.
SurfaceColors colors_at(const Scene& scene, const Hit& hit, std::uint64_t& decisions);
SurfaceColors colors_at(const Scene& scene, const Hit& hit);

/// Light that a hit sends back without any light source: ambient light and emission.
glm::dvec3 own_light(const Scene& scene, const SurfaceColors& colors);

/// `hit.ns`, turned against `direction` for materials that are two-sided.
glm::dvec3 shading_normal(const Material& material, const Hit& hit, const glm::dvec3& direction);

/// What a light brings to a hit as if nothing were in between.
struct LightAtHit {
    glm::dvec3 to_light{0};  ///< unit
    double distance = 0;     ///< infinite for directional lights
    glm::dvec3 brought{0};   ///< sent on towards `to_viewer`
};

/// `ns` and `to_viewer` are unit vectors.
LightAtHit light_at(const Light& light, const Material& material, const SurfaceColors& colors,
                    const glm::dvec3& position, const glm::dvec3& ns, const glm::dvec3& to_viewer);

/// The rays that a hit sends on with their weights; black ones are not sent.
struct Scattering {
    glm::dvec3 reflected{0}, transmitted{0};  ///< unit
    glm::dvec3 kr{0}, kt{0};
    bool total_reflection = false;
};

/// `direction` is a unit vector. On total reflection the transmission goes the mirror's way.
Scattering scatter(const Material& material, const SurfaceColors& colors, const Hit& hit,
                   const glm::dvec3& direction);

/// What is left of light that came `distance` far: `a` as Light::attenuation. Nothing comes from
/// infinity unless it does not depend on the distance.
double attenuated(const glm::vec3& a, double distance);

/// Whether a channel of `light` is a normal number in single precision: what the kernels can see of it.
bool any_in_float(const glm::dvec3& light);

}  // namespace sahl::oracle
