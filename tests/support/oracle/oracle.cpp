#include "tests/support/oracle/oracle.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/oracle/texture.h"

namespace sahl::oracle {
namespace {

using glm::dvec3;

bool any(const glm::vec3& color) { return color.x != 0 || color.y != 0 || color.z != 0; }

/// Whether a channel is a normal number in single precision: what the kernels can see of it.
bool any_in_float(const dvec3& color) { return std::max({color.x, color.y, color.z}) >= 0x1p-126; }

void decide(PathRecord& record, std::uint64_t decision) {
    record.signature = (record.signature ^ (decision + 0x9e3779b97f4a7c15U)) * 0xff51afd7ed558ccdU;
    record.signature ^= record.signature >> 32U;
}

/// What is left of light that came `distance` far: `a` as Light::attenuation. Nothing comes from
/// infinity unless it does not depend on the distance.
double attenuated(const glm::vec3& a, double distance) {
    const dvec3 parts(a);
    if (parts.y == 0 && parts.z == 0) return 1 / parts.x;
    return 1 / (parts.x + parts.y * distance + parts.z * distance * distance);
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

/// A ray on its way through the tree.
struct Oracle::Branch {
    Ray ray;
    dvec3 weight;
    int generation;
    SurfaceId start;
    glm::vec3 attenuation{1, 0, 0};  ///< of what comes back along it, by its length
};

Oracle::Oracle(const Scene& scene) : scene_(scene), shapes_(place_shapes(scene)) {}

std::optional<Hit> Oracle::closest_hit(const Ray& ray, double t_min, double t_max,
                                       const SurfaceId& start) const {
    std::optional<Hit> best;
    for (const PlacedShape& placed : shapes_) {
        if (!placed.shape.may_cross(ray)) continue;
        const SurfaceId id{placed.primitive, placed.instance};
        const Crossings crossings = placed.shape.cross(ray, id == start);
        for (int i = 0; i < crossings.count; ++i) {
            const Crossing& crossing = crossings.at[i];
            if (!(crossing.t > t_min && crossing.t < t_max)) continue;
            t_max = crossing.t;
            best = Hit{crossing.t,
                       ray.origin + crossing.t * ray.direction,
                       crossing.ng,
                       crossing.ns,
                       crossing.uv,
                       crossing.barycentric,
                       id,
                       crossing.part,
                       crossings.margin};
        }
    }
    return best;
}

dvec3 Oracle::transmittance(const Ray& ray, double t_max, const SurfaceId& start, int& crossed) const {
    dvec3 passed(1);
    crossed = 0;
    for (const PlacedShape& placed : shapes_) {
        if (!placed.shape.may_cross(ray)) continue;
        const Crossings crossings =
            placed.shape.cross(ray, SurfaceId{placed.primitive, placed.instance} == start);
        for (int i = 0; i < crossings.count; ++i) {
            if (!(crossings.at[i].t > 0 && crossings.at[i].t < t_max)) continue;
            const glm::vec3& transmission =
                scene_.materials[scene_.primitives[placed.primitive].material].transmission;
            if (!any(transmission)) return dvec3(0);
            passed *= dvec3(transmission);
            ++crossed;
        }
    }
    return passed;
}

double Oracle::edge_distance(const Ray& ray) const {
    double least = infinity;
    for (const PlacedShape& placed : shapes_) least = std::min(least, placed.shape.cross(ray, false).margin);
    return least;
}

dvec3 Oracle::color_at(const Hit& hit, glm::vec3 Material::*color,
                       std::uint32_t MaterialTextures::*texture) const {
    const Material& material = material_of(hit);
    std::uint64_t ignored = 0;
    return textured(scene_, material.*color, material.textures.*texture, hit.position, hit.uv, ignored);
}

dvec3 Oracle::color_at(const Hit& hit, glm::vec3 Material::*color, std::uint32_t MaterialTextures::*texture,
                       PathRecord& record) const {
    const Material& material = material_of(hit);
    std::uint64_t decisions = 1;
    const dvec3 result =
        textured(scene_, material.*color, material.textures.*texture, hit.position, hit.uv, decisions);
    decide(record, decisions);
    return result;
}

PathRecord Oracle::trace(const Ray& ray, int depth) const {
    PathRecord record;
    record.radiance.resize(static_cast<std::size_t>(depth) + 1, dvec3(0));
    record.counts.resize(static_cast<std::size_t>(depth) + 1);
    trace({{ray.origin, glm::normalize(ray.direction)}, dvec3(1), 0, {}}, depth, record);
    return record;
}

void Oracle::trace(const Branch& branch, int depth, PathRecord& record) const {
    const auto generation = static_cast<std::size_t>(branch.generation);
    ++record.counts[generation].rays;
    const std::optional<Hit> hit = closest_hit(branch.ray, 0, infinity, branch.start);
    decide(record, hit ? hit->id.primitive : no_primitive);
    const dvec3 weight = branch.weight * attenuated(branch.attenuation, hit ? hit->t : infinity);
    if (!hit) {
        record.radiance[generation] += weight * dvec3(scene_.background);
        return;
    }
    decide(record, std::uint64_t{hit->id.instance} << 8U | static_cast<std::uint64_t>(hit->part));
    const Material& material = material_of(*hit);
    const dvec3& direction = branch.ray.direction;
    const bool ns_away = glm::dot(hit->ns, direction) > 0;
    const bool entering = glm::dot(hit->ng, direction) < 0;
    decide(record, (ns_away ? 2U : 0U) + (entering ? 1U : 0U));
    const dvec3 facing = ns_away ? -hit->ns : hit->ns;
    const dvec3 ambient = color_at(*hit, &Material::ambient, &MaterialTextures::ambient, record);
    const dvec3 emission = color_at(*hit, &Material::emission, &MaterialTextures::emission, record);
    const Branch arrived{branch.ray, weight, branch.generation, branch.start};
    record.radiance[generation] +=
        weight * (ambient * dvec3(scene_.ambient) + emission +
                  direct_light(arrived, *hit, material.two_sided ? facing : hit->ns, record));
    if (branch.generation == depth) return;

    // Snell: the part of the direction along the surface grows by the ratio of the indices. Where
    // that leaves no room for the part across it, reflection is total and both go one way.
    dvec3 mirrored = color_at(*hit, &Material::reflection, &MaterialTextures::reflection, record);
    if (any(material.transmission)) {
        const auto inside = static_cast<double>(material.ior);
        const auto outside = static_cast<double>(material.ior_outside);
        const double eta = entering ? outside / inside : inside / outside;
        const dvec3 along = eta * (direction - glm::dot(direction, facing) * facing);
        const double across_squared = 1 - glm::dot(along, along);
        decide(record, across_squared < 0 ? 1U : 0U);
        if (across_squared < 0) {
            mirrored += dvec3(material.transmission);
        } else {
            const dvec3 refracted = glm::normalize(along - std::sqrt(across_squared) * facing);
            trace({{hit->position, refracted},
                   weight * dvec3(material.transmission),
                   branch.generation + 1,
                   hit->id},
                  depth, record);
        }
    }
    if (mirrored != dvec3(0)) {
        trace({{hit->position, reflect(direction, facing)},
               weight * mirrored,
               branch.generation + 1,
               hit->id,
               material.reflection_attenuation},
              depth, record);
    }
}

dvec3 Oracle::direct_light(const Branch& branch, const Hit& hit, const dvec3& ns, PathRecord& record) const {
    const Material& material = material_of(hit);
    const dvec3 diffuse = color_at(hit, &Material::diffuse, &MaterialTextures::diffuse, record);
    const dvec3 specular = color_at(hit, &Material::specular, &MaterialTextures::specular, record);
    const dvec3 to_viewer = -branch.ray.direction;
    dvec3 sum(0);
    for (const Light& light : scene_.lights) {
        dvec3 to_light = light.position;
        double distance = infinity;
        double arriving = 1;
        if (light.kind != LightKind::directional) {
            to_light -= hit.position;
            distance = glm::length(to_light);
            arriving = attenuated(light.attenuation, distance);
        }
        to_light = glm::normalize(to_light);
        arriving *= spot_share(light, -to_light);
        const double cosine = glm::dot(ns, to_light);
        double highlight = 0;
        if (material.specular_model == SpecularModel::blinn) {
            highlight = std::max(glm::dot(ns, glm::normalize(to_light + to_viewer)), 0.0);
        } else if (cosine > 0) {
            highlight = std::max(glm::dot(-reflect(to_light, ns), to_viewer), 0.0);
        }
        const double shine = highlight > 0 ? std::pow(highlight, static_cast<double>(material.shininess)) : 0;
        const dvec3 brought =
            dvec3(light.color) * arriving * (diffuse * std::max(cosine, 0.0) + specular * shine);
        const bool traced = any_in_float(branch.weight * brought);
        int crossed = 0;
        if (traced) {
            ++record.counts[static_cast<std::size_t>(branch.generation)].shadow_rays;
            const dvec3 passed = transmittance({hit.position, to_light}, distance, hit.id, crossed);
            if (passed == dvec3(0)) crossed = -1;
            sum += passed * brought;
        }
        decide(record, traced ? static_cast<std::uint64_t>(crossed + 2) : 0U);
    }
    return sum;
}

}  // namespace sahl::oracle
