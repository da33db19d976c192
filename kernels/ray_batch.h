// Ray batches, hits and children as structures of arrays (device_types.h), and the range of rays
// that a work-item handles.
#ifndef SAHL_RAY_BATCH_H
#define SAHL_RAY_BATCH_H

#include "kernels/device_types.h"
#include "kernels/hit.h"
#include "kernels/real.h"

// Each work-item takes SAHL_RAYS_PER_ITEM neighbours one after the other: many on a CPU, where a
// work-group costs more than a ray, one on a GPU. The host gives it.
#define SAHL_FOR_EACH_RAY(i, count)                                \
    for (uint i = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM,     \
              i##_end = SAHL_MIN(i + SAHL_RAYS_PER_ITEM, (count)); \
         i < i##_end; ++i)

static inline float3 load_soa3(const global float* arrays, uint first, uint capacity, uint i) {
    const global float* p = arrays + (size_t)first * capacity + i;
    return (float3)(p[0], p[capacity], p[2u * (size_t)capacity]);
}

static inline void store_soa3(global float* arrays, uint first, uint capacity, uint i, float3 v) {
    global float* p = arrays + (size_t)first * capacity + i;
    p[0] = v.x;
    p[capacity] = v.y;
    p[2u * (size_t)capacity] = v.z;
}

static inline Ray load_ray(const global float* rays, const global uint* ray_ids, uint capacity, uint i) {
    Ray ray;
    ray.origin = load_soa3(rays, SAHL_RAY_ORIGIN, capacity, i);
    ray.direction = load_soa3(rays, SAHL_RAY_DIRECTION, capacity, i);
    ray.exclude = ray_ids[(size_t)SAHL_RAY_EXCLUDE * capacity + i] & SAHL_ID_MASK;
    ray.instance = ray_ids[(size_t)SAHL_RAY_INSTANCE * capacity + i];
    return ray;
}

/// A vector stored as floats and what they lack.
static inline real3 load_soa3_real(const global float* arrays, uint first, uint first_low, uint capacity,
                                   uint i) {
    return convert_real3(load_soa3(arrays, first, capacity, i)) +
           convert_real3(load_soa3(arrays, first_low, capacity, i));
}

static inline void store_hit(global float* hits, global uint* hit_ids, uint capacity, uint i,
                             const HitState* hit) {
    store_soa3(hits, SAHL_HIT_T, capacity, i, (float3)(hit->t, hit->u, hit->v));
    hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i] = hit->primitive;
    hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i] = hit->instance;
}

/// Stores a ray that starts at `origin`, exactly, and is traced from `traced_origin`. `start`: the
/// primitive that it starts on, with SAHL_RAY_ATTENUATED.
static inline void store_ray(global float* rays, global uint* ray_ids, uint capacity, uint i,
                             float3 traced_origin, real3 origin, real3 direction, uint start, uint instance,
                             float3 weight, uint pixel) {
    float3 traced_direction = round3(direction);
    store_soa3(rays, SAHL_RAY_ORIGIN, capacity, i, traced_origin);
    store_soa3(rays, SAHL_RAY_ORIGIN_LOW, capacity, i, round3(origin - convert_real3(traced_origin)));
    store_soa3(rays, SAHL_RAY_DIRECTION, capacity, i, traced_direction);
    store_soa3(rays, SAHL_RAY_DIRECTION_LOW, capacity, i,
               round3(direction - convert_real3(traced_direction)));
    store_soa3(rays, SAHL_RAY_WEIGHT, capacity, i, weight);
    ray_ids[(size_t)SAHL_RAY_PIXEL * capacity + i] = pixel;
    ray_ids[(size_t)SAHL_RAY_EXCLUDE * capacity + i] = start;
    ray_ids[(size_t)SAHL_RAY_INSTANCE * capacity + i] = instance;
}

#endif
