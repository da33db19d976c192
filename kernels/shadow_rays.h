// A list of shadow rays in private memory, which a work-item gathers, has traced and reads.
#ifndef SAHL_SHADOW_RAYS_H
#define SAHL_SHADOW_RAYS_H

#include "kernels/hit.h"
#include "kernels/rays_per_item.h"

typedef struct {
    float origin[3][SAHL_SHADOW_RAYS], direction[3][SAHL_SHADOW_RAYS];
    float t_max[SAHL_SHADOW_RAYS];
    uint start_primitive[SAHL_SHADOW_RAYS], start_instance[SAHL_SHADOW_RAYS];
    uint occlusion[SAHL_SHADOW_RAYS];  // SAHL_HIT_*, once traced
    uint count;
} ShadowRays;

static inline void add_shadow_ray(ShadowRays* list, const Ray* ray, float t_max) {
    const uint k = list->count++;
    list->origin[0][k] = ray->origin.x;
    list->origin[1][k] = ray->origin.y;
    list->origin[2][k] = ray->origin.z;
    list->direction[0][k] = ray->direction.x;
    list->direction[1][k] = ray->direction.y;
    list->direction[2][k] = ray->direction.z;
    list->t_max[k] = t_max;
    list->start_primitive[k] = ray->exclude;
    list->start_instance[k] = ray->instance;
}

static inline Ray shadow_ray(const ShadowRays* list, uint k) {
    Ray ray;
    ray.origin = (float3)(list->origin[0][k], list->origin[1][k], list->origin[2][k]);
    ray.direction = (float3)(list->direction[0][k], list->direction[1][k], list->direction[2][k]);
    ray.exclude = list->start_primitive[k];
    ray.instance = list->start_instance[k];
    return ray;
}

/// What any-hit traversal has gathered as one of SAHL_HIT_*: what is opaque hides what is transparent.
static inline uint strongest_occlusion(uint occlusion) {
    return occlusion & SAHL_HIT_OPAQUE ? SAHL_HIT_OPAQUE : occlusion;
}

#endif
