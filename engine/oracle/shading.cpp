#include "engine/oracle/shading.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/oracle/texture.h"

namespace sahl::oracle {
namespace {

using glm::dvec3;

const Material& material_of(const Scene& scene, const Hit& hit) {
    return scene.materials[scene.primitives[hit.id.primitive].material];
}

/// How much of a spot's light goes along `from_light` (unit).
double spot_share(const Light& light, const dvec3& from_light) {
    if (light.kind != LightKind::spot) return 1;
    const double cosine = glm::dot(glm::normalize(dvec3(light.direction)), from_light);
    const double outer = std::cos(glm::radians(light.outer_angle));
    const double inner = std::cos(glm::radians(light.inner_angle));
    if (cosine >= inner) return 1;
    if (cosine <= outer) return 0;
    const double s = (cosine - outer) / (inner - outer);
    return s * s * (3 - 2 * s);
}

dvec3 reflect(const dvec3& direction, const dvec3& normal) {
    return direction - 2 * glm::dot(direction, normal) * normal;
}

}  // namespace

double attenuated(const glm::vec3& a, double distance) {
    const dvec3 parts(a);
    if (parts.y == 0 && parts.z == 0) return 1 / parts.x;
    return 1 / (parts.x + parts.y * distance + parts.z * distance * distance);
}

bool any_in_float(const dvec3& light) { return std::max({light.x, light.y, light.z}) >= 0x1p-126; }

SurfaceColors colors_at(const Scene& scene, const Hit& hit, std::uint64_t& decisions) {
    const Material& material = material_of(scene, hit);
    const auto color = [&](const glm::vec3& plain, std::uint32_t texture) {
        return textured(scene, plain, texture, hit.position, hit.uv, decisions);
    };
    const MaterialTextures& textures = material.textures;
    return {color(material.ambient, textures.ambient), color(material.diffuse, textures.diffuse),
            color(material.specular, textures.specular), color(material.emission, textures.emission),
            color(material.reflection, textures.reflection)};
}

SurfaceColors colors_at(const Scene& scene, const Hit& hit) {
    std::uint64_t ignored = 0;
    return colors_at(scene, hit, ignored);
}

dvec3 own_light(const Scene& scene, const SurfaceColors& colors) {
    return colors.ambient * dvec3(scene.ambient) + colors.emission;
}

dvec3 shading_normal(const Material& material, const Hit& hit, const dvec3& direction) {
    return material.two_sided && glm::dot(hit.ns, direction) > 0 ? -hit.ns : hit.ns;
}

LightAtHit light_at(const Light& light, const Material& material, const SurfaceColors& colors,
                    const dvec3& position, const dvec3& ns, const dvec3& to_viewer) {
    LightAtHit result;
    result.to_light = light.position;
    result.distance = infinity;
    double arriving = 1;
    if (light.kind != LightKind::directional) {
        result.to_light -= position;
        result.distance = glm::length(result.to_light);
        arriving = attenuated(light.attenuation, result.distance);
    }
    result.to_light = glm::normalize(result.to_light);
    arriving *= spot_share(light, -result.to_light);
    const double cosine = glm::dot(ns, result.to_light);
    double highlight = 0;
    if (material.specular_model == SpecularModel::blinn) {
        highlight = std::max(glm::dot(ns, glm::normalize(result.to_light + to_viewer)), 0.0);
    } else if (cosine > 0) {
        highlight = std::max(glm::dot(-reflect(result.to_light, ns), to_viewer), 0.0);
    }
    const double shine = highlight > 0 ? std::pow(highlight, static_cast<double>(material.shininess)) : 0;
    result.brought =
        dvec3(light.color) * arriving * (colors.diffuse * std::max(cosine, 0.0) + colors.specular * shine);
    return result;
}

// Snell: the part of the direction along the surface grows by the ratio of the indices. Where that
// leaves no room for the part across it, reflection is total and both go one way.
Scattering scatter(const Material& material, const SurfaceColors& colors, const Hit& hit,
                   const dvec3& direction) {
    const dvec3 facing = glm::dot(hit.ns, direction) > 0 ? -hit.ns : hit.ns;
    Scattering result;
    result.reflected = reflect(direction, facing);
    result.kr = colors.reflection;
    if (material.transmission == glm::vec3(0)) return result;
    const auto inside = static_cast<double>(material.ior);
    const auto outside = static_cast<double>(material.ior_outside);
    const bool entering = glm::dot(hit.ng, direction) < 0;
    const double eta = entering ? outside / inside : inside / outside;
    const dvec3 along = eta * (direction - glm::dot(direction, facing) * facing);
    const double across_squared = 1 - glm::dot(along, along);
    result.total_reflection = across_squared < 0;
    if (result.total_reflection) {
        result.kr += dvec3(material.transmission);
    } else {
        result.transmitted = glm::normalize(along - std::sqrt(across_squared) * facing);
        result.kt = dvec3(material.transmission);
    }
    return result;
}

}  // namespace sahl::oracle
