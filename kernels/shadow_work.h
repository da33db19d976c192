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

/// The light that lamp `l` would bring to hit i.
static inline float3 brought_light(const ShadowWork* work, uint l, uint i) {
    return load_soa3(work->light, 3u * l, work->capacity, i);
}

/// Of hits i to i + SAHL_LANES - 1 before `end`, bits of those to which lamp `l` would bring light.
static inline uint lanes_to_light(const ShadowWork* work, uint l, uint i, uint end) {
    const intv have =
        (vloadv(work->outcomes + i) >= SAHL_OUTCOME_SHADOW_RAY) & (lane_numbers() < (intv)((int)(end - i)));
    return lane_bits(have) == 0u
               ? 0u
               : lane_bits(have & nonzerov(load_soa3v(work->light, 3u * l, work->capacity, i)));
}

static inline RayLanes rays_to_light(const ShadowWork* work, uint l, uint i) {
    const floatv3 position = load_soa3v(work->surfaces, SAHL_SURFACE_POSITION, work->capacity, i);
    const floatv3 offset = load_soa3v(work->surfaces, SAHL_SURFACE_OFFSET, work->capacity, i);
    const global DeviceLight* light = work->lights + l;
    RayLanes rays;
    rays.origin = offset_origins(position, offset, vectors_to_light(light, position));
    rays.direction = vectors_to_light(light, rays.origin);
    rays.primitive = load_idsv(work->hit_ids, SAHL_HIT_PRIMITIVE, work->capacity, i);
    rays.instance = load_idsv(work->hit_ids, SAHL_HIT_INSTANCE, work->capacity, i);
    return rays;
}

/// The part of the light that comes through along `ray` up to t_max, which meets SAHL_HIT_* `occlusion`: 0
/// behind an opaque surface, else the product of the transmissions of the surfaces in between, each crossing
/// once, in order. `first`: the first crossings, if they are known.
static inline float3 transmittance(const Bvh* bvh, const ShadowWork* work, const Ray* ray, float t_max,
                                   uint occlusion, const Crossings* first) {
    SAHL_COUNT(bvh, SAHL_COUNT_LIT, occlusion == SAHL_HIT_OPAQUE ? 0u : 1u);
    if (occlusion != SAHL_HIT_TRANSPARENT) {
        return (float3)(occlusion == SAHL_HIT_NOTHING ? 1.0f : 0.0f);
    }
    float3 through = (float3)(1.0f);
    HitState range = hit_state(0.0f, t_max);
    Crossings collected;
    for (const Crossings* crossings = first;; crossings = 0) {
        if (crossings == 0) {
            collect_crossings(bvh, ray, range, &collected);
            crossings = &collected;
        }
        for (uint k = 0; k < crossings->count; ++k) {
            const uint primitive = (uint)crossings->rank[k];
            through *= load3(work->materials[work->primitives[primitive].material].transmission);
            range.t_min = crossings->t[k];
            range.min_rank = crossings->rank[k];
        }
        if (crossings->count < SAHL_MOST_CROSSINGS) {
            return through;
        }
    }
}

static inline void add_light(const ShadowWork* work, uint i, float3 light) {
    const float3 sum = load_soa3(work->contributions, 0u, work->capacity, i);
    store_soa3(work->contributions, 0u, work->capacity, i, sum + light);
}

/// Gathers lamp l's shadow rays from hits first..end-1; hits[k]: the hit that ray k of the list starts at.
SAHL_NOINLINE void gather_shadow_rays(const ShadowWork* work, uint l, uint first, uint end, ShadowRays* list,
                                      uint* hits) {
    const float t_max = shadow_t_max(work->lights + l);
    list->count = 0;
    for (uint i = first; i < end; i += SAHL_LANES) {
        const uint lanes = lanes_to_light(work, l, i, end);
        if (lanes != 0u) {
            const RayLanes rays = rays_to_light(work, l, i);
            uint k = list->count;
            for (uint rest = lanes; rest != 0u; rest &= rest - 1u) {
                hits[k++] = i + lowest_lane(rest);
            }
            add_shadow_rays(list, &rays, lanes, t_max);
        }
    }
}

/// Adds what the list's rays, whose occlusion is known, bring of lamp l's light.
SAHL_NOINLINE void add_light_of_list(const Bvh* bvh, const ShadowWork* work, uint l, const ShadowRays* list,
                                     const uint* hits) {
    const float t_max = shadow_t_max(work->lights + l);
    for (uint k = 0; k < list->count; ++k) {
        if (list->occlusion[k] != SAHL_HIT_OPAQUE) {
            const Ray ray = shadow_ray(list, k);
            const Crossings* first = list->crossings != 0 ? list->crossings + k : 0;
            add_light(work, hits[k],
                      brought_light(work, l, hits[k]) *
                          transmittance(bvh, work, &ray, t_max, list->occlusion[k], first));
        }
    }
}

#endif
