#include "tests/support/oracle/oracle.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

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

dvec3 reflect(const dvec3& direction, const dvec3& normal) {
    return direction - 2 * glm::dot(direction, normal) * normal;
}

}  // namespace

/// A ray on its way through the tree.
struct Oracle::Branch {
    Ray ray;
    dvec3 weight;
    int generation;
    std::uint32_t start;
};

Oracle::Oracle(const Scene& scene) : scene_(scene) {
    shapes_.reserve(scene.primitives.size());
    for (const Primitive& primitive : scene.primitives) shapes_.emplace_back(scene, primitive);
}

std::optional<Hit> Oracle::closest_hit(const Ray& ray, double t_min, double t_max,
                                       std::uint32_t start) const {
    std::optional<Hit> best;
    for (std::uint32_t id = 0; id < shapes_.size(); ++id) {
        if (!shapes_[id].may_cross(ray)) continue;
        const Crossings crossings = shapes_[id].cross(ray, id == start);
        for (int i = 0; i < crossings.count; ++i) {
            const Crossing& crossing = crossings.at[i];
            if (!(crossing.t > t_min && crossing.t < t_max)) continue;
            t_max = crossing.t;
            best = Hit{crossing.t,      ray.origin + crossing.t * ray.direction,
                       crossing.ng,     crossing.ns,
                       crossing.uv,     id,
                       crossings.margin};
        }
    }
    return best;
}

dvec3 Oracle::transmittance(const Ray& ray, double t_max, std::uint32_t start, int& crossed) const {
    dvec3 passed(1);
    crossed = 0;
    for (std::uint32_t id = 0; id < shapes_.size(); ++id) {
        if (!shapes_[id].may_cross(ray)) continue;
        const Crossings crossings = shapes_[id].cross(ray, id == start);
        for (int i = 0; i < crossings.count; ++i) {
            if (!(crossings.at[i].t > 0 && crossings.at[i].t < t_max)) continue;
            const glm::vec3& transmission = scene_.materials[scene_.primitives[id].material].transmission;
            if (!any(transmission)) return dvec3(0);
            passed *= dvec3(transmission);
            ++crossed;
        }
    }
    return passed;
}

double Oracle::edge_distance(const Ray& ray) const {
    double least = infinity;
    for (const Shape& shape : shapes_) least = std::min(least, shape.cross(ray, false).margin);
    return least;
}

PathRecord Oracle::trace(const Ray& ray, int depth) const {
    PathRecord record;
    record.radiance.resize(static_cast<std::size_t>(depth) + 1, dvec3(0));
    record.counts.resize(static_cast<std::size_t>(depth) + 1);
    trace({{ray.origin, glm::normalize(ray.direction)}, dvec3(1), 0, no_primitive}, depth, record);
    return record;
}

void Oracle::trace(const Branch& branch, int depth, PathRecord& record) const {
    const auto generation = static_cast<std::size_t>(branch.generation);
    ++record.counts[generation].rays;
    const std::optional<Hit> hit = closest_hit(branch.ray, 0, infinity, branch.start);
    decide(record, hit ? hit->primitive : no_primitive);
    if (!hit) {
        record.radiance[generation] += branch.weight * dvec3(scene_.background);
        return;
    }
    const Material& material = scene_.materials[scene_.primitives[hit->primitive].material];
    const dvec3& direction = branch.ray.direction;
    const bool ns_away = glm::dot(hit->ns, direction) > 0;
    const bool entering = glm::dot(hit->ng, direction) < 0;
    decide(record, (ns_away ? 2U : 0U) + (entering ? 1U : 0U));
    const dvec3 facing = ns_away ? -hit->ns : hit->ns;
    const dvec3 local = dvec3(material.ambient) + dvec3(material.emission) +
                        direct_light(branch, *hit, material.two_sided ? facing : hit->ns, record);
    record.radiance[generation] += branch.weight * local;
    if (branch.generation == depth) return;

    // Snell: the part of the direction along the surface grows by the ratio of the indices. Where
    // that leaves no room for the part across it, reflection is total and both go one way.
    dvec3 mirrored(material.reflection);
    const auto ior = static_cast<double>(material.ior);
    if (any(material.transmission)) {
        const double eta = entering ? 1 / ior : ior;
        const dvec3 along = eta * (direction - glm::dot(direction, facing) * facing);
        const double across_squared = 1 - glm::dot(along, along);
        decide(record, across_squared < 0 ? 1U : 0U);
        if (across_squared < 0) {
            mirrored += dvec3(material.transmission);
        } else {
            const dvec3 refracted = glm::normalize(along - std::sqrt(across_squared) * facing);
            trace({{hit->position, refracted},
                   branch.weight * dvec3(material.transmission),
                   branch.generation + 1,
                   hit->primitive},
                  depth, record);
        }
    }
    if (mirrored != dvec3(0)) {
        trace({{hit->position, reflect(direction, facing)},
               branch.weight * mirrored,
               branch.generation + 1,
               hit->primitive},
              depth, record);
    }
}

dvec3 Oracle::direct_light(const Branch& branch, const Hit& hit, const dvec3& ns, PathRecord& record) const {
    const Material& material = scene_.materials[scene_.primitives[hit.primitive].material];
    const dvec3 to_viewer = -branch.ray.direction;
    dvec3 sum(0);
    for (const Light& light : scene_.lights) {
        dvec3 to_light = light.position;
        double distance = infinity;
        double attenuation = 1;
        if (light.kind == LightKind::point) {
            to_light -= hit.position;
            distance = glm::length(to_light);
            attenuation = light.attenuation.x + light.attenuation.y * distance +
                          light.attenuation.z * distance * distance;
        }
        to_light = glm::normalize(to_light);
        const double cosine = glm::dot(ns, to_light);
        double highlight = 0;
        if (material.specular_model == SpecularModel::blinn) {
            highlight = std::max(glm::dot(ns, glm::normalize(to_light + to_viewer)), 0.0);
        } else if (cosine > 0) {
            highlight = std::max(glm::dot(-reflect(to_light, ns), to_viewer), 0.0);
        }
        const double shine = highlight > 0 ? std::pow(highlight, static_cast<double>(material.shininess)) : 0;
        const dvec3 brought =
            dvec3(light.color) / attenuation *
            (dvec3(material.diffuse) * std::max(cosine, 0.0) + dvec3(material.specular) * shine);
        const bool traced = any_in_float(branch.weight * brought);
        int crossed = 0;
        if (traced) {
            ++record.counts[static_cast<std::size_t>(branch.generation)].shadow_rays;
            const dvec3 passed = transmittance({hit.position, to_light}, distance, hit.primitive, crossed);
            if (passed == dvec3(0)) crossed = -1;
            sum += passed * brought;
        }
        decide(record, traced ? static_cast<std::uint64_t>(crossed + 2) : 0U);
    }
    return sum;
}

}  // namespace sahl::oracle
