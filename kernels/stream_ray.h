// A ray of a stream (traverse_stream.h) with all that its tests need, and how SAHL_LANES of them are prepared
// together: what triangle.h and bvh.h find for one ray, operation by operation, and then transposed, from
// arrays of a number each to one record a ray.
#ifndef SAHL_STREAM_RAY_H
#define SAHL_STREAM_RAY_H

#include "kernels/ray_batch.h"
#include "kernels/shadow_rays.h"
#include "kernels/triangle.h"

/// The rays of a stream and what takes their hits: those of a batch (ray_batch.h), or for any hit a list.
typedef struct {
    const global float* rays;
    const global uint* ray_ids;
    global float* hits;
    global uint* hit_ids;
    uint capacity;
    ShadowRays* shadow_rays;
} RaySource;

/// A ray in flight. What node steps need is one cache line.
typedef struct {
    RayBoxTest boxes;  // in the world or in an instance
    float cull_t;
    uint index;         // of the ray
    WaitingChild* top;  // of its stack: the ray's next step
    RayShear shear;
    Ray ray;  // in the same space
    HitState state;
    WaitingChild* bottom;
} __attribute__((aligned(64))) StreamRay;

static inline Ray source_ray(const RaySource* source, uint index, bool any_hit) {
    return any_hit ? shadow_ray(source->shadow_rays, index)
                   : load_ray(source->rays, source->ray_ids, source->capacity, index);
}

/// SAHL_LANES rays. Behind the source's last they are anything, but there: batches and lists have room for
/// multiples of SAHL_LANES.
static inline RayLanes source_lanes(const RaySource* source, uint first, bool any_hit) {
    RayLanes lanes;
    if (any_hit) {
        const ShadowRays* list = source->shadow_rays;
        lanes.origin = (floatv3){vloadv(list->origin[0] + first), vloadv(list->origin[1] + first),
                                 vloadv(list->origin[2] + first)};
        lanes.direction = (floatv3){vloadv(list->direction[0] + first), vloadv(list->direction[1] + first),
                                    vloadv(list->direction[2] + first)};
        lanes.primitive = vloadv(list->start_primitive + first);
        lanes.instance = vloadv(list->start_instance + first);
    } else {
        lanes.origin = load_soa3v(source->rays, SAHL_RAY_ORIGIN, source->capacity, first);
        lanes.direction = load_soa3v(source->rays, SAHL_RAY_DIRECTION, source->capacity, first);
        lanes.primitive =
            load_idsv(source->ray_ids, SAHL_RAY_EXCLUDE, source->capacity, first) & SAHL_ID_MASK;
        lanes.instance = load_idsv(source->ray_ids, SAHL_RAY_INSTANCE, source->capacity, first);
    }
    return lanes;
}

/// ray_box_test() with the members behind it, as the words of each ray.
static inline void box_tests_of_lanes(const floatv* origin, const floatv* direction, floatv cull_t,
                                      uintv index, float extent, floatv* words) {
    uintv octant = 0u;
#pragma unroll
    for (uint k = 0; k < 3u; ++k) {
        const floatv r = finite_inverse(direction[k]);
        const floatv e = (fabs(origin[k]) + extent) * 0x1p-20f * fabs(r);
        words[k] = r;
        words[3u + k] = -(origin[k] * r) - e;
        words[6u + k] = -(origin[k] * r) + e;
        octant |= as_uintv(r) >> 31 << k;
    }
    const uintv near_x = (octant & 1u) * 96u, near_y = 32u + (octant >> 1 & 1u) * 96u,
                near_z = 64u + (octant >> 2) * 96u;
    words[9] = as_floatv(octant | near_x << 8 | near_y << 16 | near_z << 24);
    words[10] = as_floatv(0x04050607u ^ octant * 0x01010101u);
    words[11] = as_floatv(0x00010203u ^ octant * 0x01010101u);
    words[12] = cull_t;
    words[13] = as_floatv(index);
    words[14] = words[15] = (floatv)(0.0f);
}

/// ray_shear(), as the words of each ray.
static inline void shears_of_lanes(floatv3 origin, floatv3 direction, floatv* words) {
    const floatv x = fabs(direction.x), y = fabs(direction.y), z = fabs(direction.z);
    const intv along_x = (x >= y) & (x >= z), along_y = y >= z;
#define SAHL_FROM_AXIS(along_x_, along_y_, along_z_) \
    (along_x ? (along_x_) : (along_y ? (along_y_) : (along_z_)))
    words[0] = as_floatv(SAHL_FROM_AXIS((intv)(1), (intv)(2), (intv)(0)));
    words[1] = as_floatv(SAHL_FROM_AXIS((intv)(2), (intv)(0), (intv)(1)));
    words[2] = as_floatv(SAHL_FROM_AXIS((intv)(0), (intv)(1), (intv)(2)));
    words[3] = SAHL_FROM_AXIS(origin.y, origin.z, origin.x);
    words[4] = SAHL_FROM_AXIS(origin.z, origin.x, origin.y);
    words[5] = SAHL_FROM_AXIS(origin.x, origin.y, origin.z);
    const floatv dz = SAHL_FROM_AXIS(direction.x, direction.y, direction.z);
    words[6] = -(SAHL_FROM_AXIS(direction.y, direction.z, direction.x) / dz);
    words[7] = -(SAHL_FROM_AXIS(direction.z, direction.x, direction.y) / dz);
#undef SAHL_FROM_AXIS
}

/// Makes rays first.. of the source ready for their way through the world, but for their stacks.
SAHL_NOINLINE void prepare_rays(const RaySource* source, uint first, float extent, StreamRay* const* rays,
                                bool any_hit) {
    const RayLanes lanes = source_lanes(source, first, any_hit);
    const floatv origin[3] = {lanes.origin.x, lanes.origin.y, lanes.origin.z};
    const floatv direction[3] = {lanes.direction.x, lanes.direction.y, lanes.direction.z};
    const floatv t_max = any_hit ? vloadv(source->shadow_rays->t_max + first) : (floatv)(INFINITY);
    // A range that ends before it begins: what cannot be traced meets no box (intersect_children()).
    const floatv cull_t = are_traceable(origin, direction) ? t_max * SAHL_CULL_SLACK : (floatv)(-INFINITY);
    const uintv exclude = lanes.instance == SAHL_WORLD ? lanes.primitive : (uintv)(SAHL_NO_PRIMITIVE);
    floatv boxes[16], shear[8];
    box_tests_of_lanes(origin, direction, cull_t, first + as_uintv(lane_numbers()), extent, boxes);
    shears_of_lanes(lanes.origin, lanes.direction, shear);
    floatv ends[8] = {origin[0],    origin[1],    origin[2],    (floatv)(0.0f),
                      direction[0], direction[1], direction[2], (floatv)(0.0f)};
    transpose8(boxes);
    transpose8(boxes + 8);
    transpose8(shear);
    transpose8(ends);
    for (uint k = 0; k < SAHL_LANES; ++k) {
        StreamRay* ray = rays[k];
        vstorev(boxes[k], (float*)ray);
        vstorev(boxes[8u + k], (float*)ray + 8);
        vstorev(shear[k], (float*)&ray->shear);
        vstorev(ends[k], (float*)&ray->ray);
        ray->ray.exclude = ((const uint*)&exclude)[k];
        ray->ray.instance = SAHL_WORLD;
        ray->state = hit_state(0.0f, ((const float*)&t_max)[k]);
    }
}
SAHL_STATIC_ASSERT(__builtin_offsetof(RayBoxTest, octant) == 36 &&
                       __builtin_offsetof(RayBoxTest, slots) == 40 &&
                       __builtin_offsetof(StreamRay, cull_t) == 48 &&
                       __builtin_offsetof(StreamRay, index) == 52 && __builtin_offsetof(StreamRay, top) == 56,
                   "the words of box_tests_of_lanes()");
SAHL_STATIC_ASSERT(sizeof(RayShear) == 32 && __builtin_offsetof(Ray, direction) == 16,
                   "the words of shears_of_lanes() and of rays");
#ifndef __ENDIAN_LITTLE__
#error "the octant and near planes of a ray are written as one word, the lowest byte first"
#endif

#endif
