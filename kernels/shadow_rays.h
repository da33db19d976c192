// A list of shadow rays in private memory, which a work-item gathers, has traced and reads.
#ifndef SAHL_SHADOW_RAYS_H
#define SAHL_SHADOW_RAYS_H

#include "kernels/hit.h"
#include "kernels/lanes.h"

typedef struct {
    float origin[3][SAHL_SHADOW_RAYS], direction[3][SAHL_SHADOW_RAYS];
    float t_max[SAHL_SHADOW_RAYS];
    uint start_primitive[SAHL_SHADOW_RAYS], start_instance[SAHL_SHADOW_RAYS];
    uint occlusion[SAHL_SHADOW_RAYS];  // SAHL_HIT_*, once traced
    Crossings* crossings;  // if not null, there packets leave those of transparent surfaces alone, by ray
    uint count;
} ShadowRays;

static inline Ray shadow_ray(const ShadowRays* list, uint k) {
    Ray ray;
    ray.origin = (float3)(list->origin[0][k], list->origin[1][k], list->origin[2][k]);
    ray.direction = (float3)(list->direction[0][k], list->direction[1][k], list->direction[2][k]);
    ray.exclude = list->start_primitive[k];
    ray.instance = list->start_instance[k];
    return ray;
}

/// Rays from SAHL_LANES hits, side by side.
typedef struct {
    floatv3 origin, direction;
    uintv primitive, instance;  // that they start on
} RayLanes;

/// Appends the rays of those lanes that are set in `lanes`.
static inline void add_shadow_rays(ShadowRays* list, const RayLanes* rays, uint lanes, float t_max) {
#define SAHL_APPEND(array, type, numbers)                                    \
    if (lanes == (1u << SAHL_LANES) - 1u) {                                  \
        vstorev(numbers, list->array + list->count);                         \
    } else {                                                                 \
        uint k = list->count;                                                \
        for (uint rest = lanes; rest != 0u; rest &= rest - 1u) {             \
            list->array[k++] = ((const type*)&(numbers))[lowest_lane(rest)]; \
        }                                                                    \
    }
    SAHL_APPEND(origin[0], float, rays->origin.x)
    SAHL_APPEND(origin[1], float, rays->origin.y)
    SAHL_APPEND(origin[2], float, rays->origin.z)
    SAHL_APPEND(direction[0], float, rays->direction.x)
    SAHL_APPEND(direction[1], float, rays->direction.y)
    SAHL_APPEND(direction[2], float, rays->direction.z)
    SAHL_APPEND(start_primitive, uint, rays->primitive)
    SAHL_APPEND(start_instance, uint, rays->instance)
#undef SAHL_APPEND
    for (const uint end = list->count + popcount(lanes); list->count < end; ++list->count) {
        list->t_max[list->count] = t_max;
    }
}

static inline Ray ray_of_lane(const RayLanes* rays, uint lane) {
    Ray ray;
    ray.origin = (float3)(((const float*)&rays->origin.x)[lane], ((const float*)&rays->origin.y)[lane],
                          ((const float*)&rays->origin.z)[lane]);
    ray.direction =
        (float3)(((const float*)&rays->direction.x)[lane], ((const float*)&rays->direction.y)[lane],
                 ((const float*)&rays->direction.z)[lane]);
    ray.exclude = ((const uint*)&rays->primitive)[lane];
    ray.instance = ((const uint*)&rays->instance)[lane];
    return ray;
}

/// What any-hit traversal has gathered as one of SAHL_HIT_*: what is opaque hides what is transparent.
static inline uint strongest_occlusion(uint occlusion) {
    return occlusion & SAHL_HIT_OPAQUE ? SAHL_HIT_OPAQUE : occlusion;
}

#endif
