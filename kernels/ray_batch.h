// Ray batches, hits and children as structures of arrays (device_types.h), and the range of rays
// that a work-item handles, one by one or SAHL_LANES at a time.
#ifndef SAHL_RAY_BATCH_H
#define SAHL_RAY_BATCH_H

#include "kernels/device_types.h"
#include "kernels/hit.h"
#include "kernels/lanes.h"

// Each work-item takes SAHL_RAYS_PER_ITEM neighbours one after the other: many on a CPU, where a
// work-group costs more than a ray, one on a GPU. The host gives it.
#define SAHL_FOR_EACH_RAY(i, count)                                \
    for (uint i = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM,     \
              i##_end = SAHL_MIN(i + SAHL_RAYS_PER_ITEM, (count)); \
         i < i##_end; ++i)

// The same by groups of SAHL_LANES neighbours, the first of which is i: `capacity` is a multiple of that, so
// that lanes behind the last ray are there to be read and written, but hold nothing.
#define SAHL_FOR_EACH_GROUP(i, count)                                                    \
    for (uint i = (uint)get_global_id(0) * SAHL_MAX(SAHL_RAYS_PER_ITEM, SAHL_LANES),     \
              i##_end = SAHL_MIN(i + SAHL_MAX(SAHL_RAYS_PER_ITEM, SAHL_LANES), (count)); \
         i < i##_end; i += SAHL_LANES)

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

static inline floatv3 load_soa3v(const global float* arrays, uint first, uint capacity, uint i) {
    const global float* p = arrays + (size_t)first * capacity + i;
    return (floatv3){vloadv(p), vloadv(p + capacity), vloadv(p + 2u * (size_t)capacity)};
}

static inline void store_soa3v(global float* arrays, uint first, uint capacity, uint i, floatv3 v) {
    global float* p = arrays + (size_t)first * capacity + i;
    vstorev(v.x, p);
    vstorev(v.y, p + capacity);
    vstorev(v.z, p + 2u * (size_t)capacity);
}

static inline uintv load_idsv(const global uint* arrays, uint array, uint capacity, uint i) {
    return vloadv(arrays + (size_t)array * capacity + i);
}

static inline void store_idsv(global uint* arrays, uint array, uint capacity, uint i, uintv ids) {
    vstorev(ids, arrays + (size_t)array * capacity + i);
}

/// Vectors stored as floats and what they lack.
static inline realv3 load_soa3v_real(const global float* arrays, uint first, uint first_low, uint capacity,
                                     uint i) {
    return add(widen(load_soa3v(arrays, first, capacity, i)),
               widen(load_soa3v(arrays, first_low, capacity, i)));
}

static inline void store_hit(global float* hits, global uint* hit_ids, uint capacity, uint i,
                             const HitState* hit) {
    store_soa3(hits, SAHL_HIT_T, capacity, i, (float3)(hit->t, hit->u, hit->v));
    hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i] = hit->primitive;
    hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i] = hit->instance;
}

/// Lanes of a group that are stored: those of `mask`, or all where `alone`, as others hold nothing yet.
typedef struct {
    intv mask;
    bool alone;
} StoredLanes;

static inline StoredLanes all_lanes(void) { return (StoredLanes){(intv)(-1), true}; }

SAHL_OVERLOAD void store_lanes(StoredLanes lanes, global float* p, floatv v) {
    vstorev(lanes.alone ? v : where(lanes.mask, v, vloadv(p)), p);
}
SAHL_OVERLOAD void store_lanes(StoredLanes lanes, global uint* p, uintv v) {
    vstorev(lanes.alone ? v : (lanes.mask ? v : vloadv(p)), p);
}

SAHL_INLINE void store_soa3_lanes(StoredLanes lanes, global float* arrays, uint first, uint capacity, uint i,
                                  floatv3 v) {
    global float* p = arrays + (size_t)first * capacity + i;
    store_lanes(lanes, p, v.x);
    store_lanes(lanes, p + capacity, v.y);
    store_lanes(lanes, p + 2u * (size_t)capacity, v.z);
}

static inline void store_id_lanes(StoredLanes lanes, global uint* arrays, uint array, uint capacity, uint i,
                                  uintv ids) {
    store_lanes(lanes, arrays + (size_t)array * capacity + i, ids);
}

/// Stores rays that start at `origin`, exactly, and are traced from `traced_origin`. `start`: the
/// primitives that they start on, with SAHL_RAY_ATTENUATED.
SAHL_INLINE void store_rays(StoredLanes lanes, global float* rays, global uint* ray_ids, uint capacity,
                            uint i, floatv3 traced_origin, realv3 origin, realv3 direction, uintv start,
                            uintv instance, floatv3 weight, uintv pixel) {
    floatv3 traced_direction = roundv(direction);
    floatv3 origin_low = roundv(sub(origin, widen(traced_origin)));
    floatv3 direction_low = roundv(sub(direction, widen(traced_direction)));
    store_soa3_lanes(lanes, rays, SAHL_RAY_ORIGIN, capacity, i, traced_origin);
    store_soa3_lanes(lanes, rays, SAHL_RAY_ORIGIN_LOW, capacity, i, origin_low);
    store_soa3_lanes(lanes, rays, SAHL_RAY_DIRECTION, capacity, i, traced_direction);
    store_soa3_lanes(lanes, rays, SAHL_RAY_DIRECTION_LOW, capacity, i, direction_low);
    store_soa3_lanes(lanes, rays, SAHL_RAY_WEIGHT, capacity, i, weight);
    store_id_lanes(lanes, ray_ids, SAHL_RAY_PIXEL, capacity, i, pixel);
    store_id_lanes(lanes, ray_ids, SAHL_RAY_EXCLUDE, capacity, i, start);
    store_id_lanes(lanes, ray_ids, SAHL_RAY_INSTANCE, capacity, i, instance);
}

#endif
