#include "engine/oracle/oracle.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/oracle/shading.h"

namespace sahl::oracle {
namespace {

using glm::dvec3;

bool any(const glm::vec3& color) { return color.x != 0 || color.y != 0 || color.z != 0; }

void decide(PathRecord& record, std::uint64_t decision) {
    record.signature = (record.signature ^ (decision + 0x9e3779b97f4a7c15U)) * 0xff51afd7ed558ccdU;
    record.signature ^= record.signature >> 32U;
}

Hit hit_at(const Ray& ray, const Crossing& crossing, const SurfaceId& id, double margin) {
    return {crossing.t,  ray.origin + crossing.t * ray.direction,
            crossing.ng, crossing.ns,
            crossing.uv, crossing.barycentric,
            id,          crossing.part,
            margin};
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
            best = hit_at(ray, crossing, id, crossings.margin);
        }
    }
    return best;
}

std::optional<Hit> Oracle::hit_near(const Ray& ray, const SurfaceId& id, double t) const {
    std::optional<Hit> best;
    for (const PlacedShape& placed : shapes_) {
        if (SurfaceId{placed.primitive, placed.instance} != id) continue;
        const Crossings crossings = placed.shape.cross(ray, false);
        for (int i = 0; i < crossings.count; ++i) {
            const Crossing& crossing = crossings.at[i];
            if (best && std::abs(best->t - t) <= std::abs(crossing.t - t)) continue;
            best = hit_at(ray, crossing, id, crossings.margin);
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
    std::uint64_t decisions = 1;
    const SurfaceColors colors = colors_at(scene_, *hit, decisions);
    decide(record, decisions);
    const Branch arrived{branch.ray, weight, branch.generation, branch.start};
    record.radiance[generation] +=
        weight * (own_light(scene_, colors) + direct_light(arrived, *hit, colors, record));
    if (branch.generation == depth) return;

    const Scattering scattered = scatter(material, colors, *hit, direction);
    decide(record, scattered.total_reflection ? 1U : 0U);
    if (scattered.kt != dvec3(0)) {
        trace({{hit->position, scattered.transmitted}, weight * scattered.kt, branch.generation + 1, hit->id},
              depth, record);
    }
    if (scattered.kr != dvec3(0)) {
        trace({{hit->position, scattered.reflected},
               weight * scattered.kr,
               branch.generation + 1,
               hit->id,
               material.reflection_attenuation},
              depth, record);
    }
}

dvec3 Oracle::direct_light(const Branch& branch, const Hit& hit, const SurfaceColors& colors,
                           PathRecord& record) const {
    const Material& material = material_of(hit);
    const dvec3& direction = branch.ray.direction;
    const dvec3 ns = shading_normal(material, hit, direction);
    dvec3 sum(0);
    for (const Light& light : scene_.lights) {
        const LightAtHit arriving = light_at(light, material, colors, hit.position, ns, -direction);
        const bool traced = any_in_float(branch.weight * arriving.brought);
        int crossed = 0;
        if (traced) {
            ++record.counts[static_cast<std::size_t>(branch.generation)].shadow_rays;
            const dvec3 passed =
                transmittance({hit.position, arriving.to_light}, arriving.distance, hit.id, crossed);
            if (passed == dvec3(0)) crossed = -1;
            sum += passed * arriving.brought;
        }
        decide(record, traced ? static_cast<std::uint64_t>(crossed + 2) : 0U);
    }
    return sum;
}

}  // namespace sahl::oracle
