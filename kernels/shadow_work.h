// What kernels that test shadow rays share: the rays of hits to the lamps, and what of their light arrives.
#ifndef SAHL_SHADOW_WORK_H
#define SAHL_SHADOW_WORK_H

#include "kernels/light.h"
#include "kernels/ray_batch.h"
#include "kernels/shadow_rays.h"
#include "kernels/surface.h"
#include "kernels/traverse_scalar.h"

/// What shadow kernels work on.
typedef struct {
    const global DevicePrimitive* primitives;
    const global DeviceMaterial* materials;
    const global DeviceLight* lights;
    const global uint* hit_ids;
    const global float* surfaces;  // SAHL_SURFACE_*
    const global float* light;     // that each lamp would bring, three arrays a lamp
    const global uint* outcomes;
    global float* contributions;
    uint capacity;
} ShadowWork;

/// Whether lamp `l` has a shadow ray from hit i; *brought: what it would bring.
static inline bool has_shadow_ray(const ShadowWork* work, uint l, uint i, float3* brought) {
    if (work->outcomes[i] < SAHL_OUTCOME_SHADOW_RAY) {
        return false;
    }
    *brought = load_soa3(work->light, 3u * l, work->capacity, i);
    return is_nonzero(*brought);
}

static inline Ray ray_to_light(const ShadowWork* work, uint l, uint i) {
    const float3 position = load_soa3(work->surfaces, SAHL_SURFACE_POSITION, work->capacity, i);
    const float3 offset = load_soa3(work->surfaces, SAHL_SURFACE_OFFSET, work->capacity, i);
    const global DeviceLight* light = work->lights + l;
    Ray ray;
    ray.origin = offset_origin(position, offset, vector_to_light(light, position));
    ray.direction = vector_to_light(light, ray.origin);
    ray.exclude = work->hit_ids[(size_t)SAHL_HIT_PRIMITIVE * work->capacity + i];
    ray.instance = work->hit_ids[(size_t)SAHL_HIT_INSTANCE * work->capacity + i];
    return ray;
}

/// The part of the light that comes through along `ray` up to t_max, which meets SAHL_HIT_* `occlusion`: 0
/// behind an opaque surface, else the product of the transmissions of the surfaces in between, each crossing
/// once, in order.
static inline float3 transmittance(const Bvh* bvh, const ShadowWork* work, const Ray* ray, float t_max,
                                   uint occlusion) {
    SAHL_COUNT(bvh, SAHL_COUNT_LIT, occlusion == SAHL_HIT_OPAQUE ? 0u : 1u);
    if (occlusion != SAHL_HIT_TRANSPARENT) {
        return (float3)(occlusion == SAHL_HIT_NOTHING ? 1.0f : 0.0f);
    }
    float3 through = (float3)(1.0f);
    HitState range = hit_state(0.0f, t_max);
    Crossings crossings;
    do {
        collect_crossings(bvh, ray, range, &crossings);
        for (uint k = 0; k < crossings.count; ++k) {
            const uint primitive = (uint)crossings.rank[k];
            through *= load3(work->materials[work->primitives[primitive].material].transmission);
            range.t_min = crossings.t[k];
            range.min_rank = crossings.rank[k];
        }
    } while (crossings.count == SAHL_MOST_CROSSINGS);
    return through;
}

static inline void add_light(const ShadowWork* work, uint i, float3 light) {
    const float3 sum = load_soa3(work->contributions, 0u, work->capacity, i);
    store_soa3(work->contributions, 0u, work->capacity, i, sum + light);
}

/// Gathers lamp l's shadow rays from hits first..end-1; hits[k]: the hit that ray k of the list starts at.
static inline void gather_shadow_rays(const ShadowWork* work, uint l, uint first, uint end, ShadowRays* list,
                                      uint* hits) {
    const float t_max = shadow_t_max(work->lights + l);
    float3 brought;
    list->count = 0;
    for (uint i = first; i < end; ++i) {
        if (has_shadow_ray(work, l, i, &brought)) {
            const Ray ray = ray_to_light(work, l, i);
            hits[list->count] = i;
            add_shadow_ray(list, &ray, t_max);
        }
    }
}

/// Adds what the list's rays, whose occlusion is known, bring of lamp l's light.
static inline void add_light_of_list(const Bvh* bvh, const ShadowWork* work, uint l, const ShadowRays* list,
                                     const uint* hits) {
    const float t_max = shadow_t_max(work->lights + l);
    float3 brought;
    for (uint k = 0; k < list->count; ++k) {
        const Ray ray = shadow_ray(list, k);
        has_shadow_ray(work, l, hits[k], &brought);
        add_light(work, hits[k], brought * transmittance(bvh, work, &ray, t_max, list->occlusion[k]));
    }
}

#endif
