// The tree as a kernel sees it and the test of a ray against the eight children of a node.
//
// Boxes must never miss a primitive inside them. Near and far planes are chosen by the sign of the
// direction, and the fused multiply-add form t = plane·r - origin·r gets addends that are moved
// outward by e = (|origin| + extent)·2^-20·|r|, which covers its cancellation and the rounding of
// the primitives' own tests (0 misses where the plain form misses tens of thousands in a million
// degenerate rays).
#ifndef SAHL_BVH_H
#define SAHL_BVH_H

#include "kernels/child_order.h"
#include "kernels/count_visits.h"
#include "kernels/device_types.h"
#include "kernels/math.h"
#include "kernels/simd.h"

// A curved surface's distance may be too short by its own rounding: boxes are culled only beyond
// this much more, and their addends leave room for the rest.
#define SAHL_CULL_SLACK (1.0f + 0x1p-20f)

typedef struct {
    const global BvhNode* nodes;
    const global uchar* leaves;
    const global float* outlines;
    const global DeviceInstance* instances;
    float extent;  // largest |coordinate| of the scene
#ifdef SAHL_COUNT_VISITS
    global ulong* counts;  // of the work-item
#endif
} Bvh;

/// Where in a node the near planes are, in bytes; the far ones are at x ^ 96, y ^ 160, z ^ 224.
typedef struct {
    uchar x, y, z;
} NearPlanes;

/// Of three components each. Packed, as the stream kernel's rays compete for the cache.
typedef struct {
    float inverse[3];  // 1/direction, finite
    float near_addend[3];
    float far_addend[3];
    uchar octant;  // bit k: inverse[k] is negative
    // Kept: compilers make branches of finding them at each node, which no processor can predict.
    NearPlanes near;
    uint slots[2];  // of children, last to first, a byte each: what AVX-512 permutes by
} RayBoxTest;

static inline NearPlanes near_planes(uint octant) {
    NearPlanes planes = {(uchar)((octant & 1u) * 96u), (uchar)(32u + (octant >> 1 & 1u) * 96u),
                         (uchar)(64u + (octant >> 2) * 96u)};
    return planes;
}

static inline float8 planes_at(const global BvhNode* node, uint offset) {
    return *(const global float8*)((const global uchar*)node + offset);
}

static inline RayBoxTest ray_box_test(float3 origin, float3 direction, float extent) {
    RayBoxTest test;
    const float4 o = (float4)(origin, 0.0f);
    const float4 r = finite_inverse((float4)(direction, 1.0f));
    const float4 e = (fabs(o) + extent) * 0x1p-20f * fabs(r);
    const float4 near = -(o * r) - e, far = -(o * r) + e;
    vstore3(r.xyz, 0, test.inverse);
    vstore3(near.xyz, 0, test.near_addend);
    vstore3(far.xyz, 0, test.far_addend);
    const uint octant = mask4(r < 0.0f);
    test.octant = (uchar)octant;
    test.near = near_planes(octant);
    test.slots[0] = 0x04050607u ^ octant * 0x01010101u;
    test.slots[1] = 0x00010203u ^ octant * 0x01010101u;
    return test;
}

/// Where between t_min and t_max the ray enters and leaves the boxes of the children; it meets those for
/// which *enter <= *leave.
static inline void intersect_children(const global BvhNode* node, const RayBoxTest* test, float t_min,
                                      float t_max, float8* enter, float8* leave) {
    const NearPlanes near = test->near;
    const float* r = test->inverse;
    const float* n = test->near_addend;
    const float* f = test->far_addend;
    float8 near_x = fma(planes_at(node, near.x), (float8)(r[0]), (float8)(n[0]));
    float8 near_y = fma(planes_at(node, near.y), (float8)(r[1]), (float8)(n[1]));
    float8 near_z = fma(planes_at(node, near.z), (float8)(r[2]), (float8)(n[2]));
    float8 far_x = fma(planes_at(node, near.x ^ 96u), (float8)(r[0]), (float8)(f[0]));
    float8 far_y = fma(planes_at(node, near.y ^ 160u), (float8)(r[1]), (float8)(f[1]));
    float8 far_z = fma(planes_at(node, near.z ^ 224u), (float8)(r[2]), (float8)(f[2]));
    // r is finite and not 0, planes are finite or infinite: no NaN comes here but from rays that cannot be
    // traced. The t_max of these is -inf (stream_ray.h), and SAHL_MIN and SAHL_MAX prefer their second
    // operand to NaN: they meet nothing.
    *enter = SAHL_MAX(SAHL_MAX(near_x, near_y), SAHL_MAX(near_z, (float8)(t_min)));
    *leave = SAHL_MIN(SAHL_MIN(far_x, far_y), SAHL_MIN(far_z, (float8)(t_max)));
}

/// A child that waits on a stack and where the ray enters it. Side by side, as a stack's top is then one
/// cache line and rays in flight compete for few.
typedef struct {
    uint child;
    float entry;
} WaitingChild;

/// Puts the children that are met (enter <= leave) on a stack that ends before `end`, the one to visit first
/// on top. Writes eight entries from `end` on, however many are met. Returns the stack's new end.
static inline WaitingChild* push_children(const global BvhNode* node, float8 enter, float8 leave,
                                          const RayBoxTest* test, WaitingChild* end) {
#if defined(SAHL_AVX512)
    const int8 slots = convert_int8(as_uchar8(vload2(0, test->slots)));
    enter = __builtin_ia32_permvarsf256(enter, slots);
    leave = __builtin_ia32_permvarsf256(leave, slots);
    const int8 child = __builtin_ia32_permvarsi256(as_int8(vload8(0, node->child)), slots);
    const uint met = mask8_le(enter, leave);
    const uint16 pairs = __builtin_shufflevector(as_uint8(child), as_uint8(enter), 0, 8, 1, 9, 2, 10, 3, 11,
                                                 4, 12, 5, 13, 6, 14, 7, 15);
    vstore8(as_ulong8(__builtin_ia32_compressdi512_mask(as_long8(pairs), (long8)(0), (uchar)met)), 0,
            (ulong*)end);
    return end + popcount(met);
#elif defined(SAHL_AVX2)
    const uint met = mask8_le(enter, leave);
    const int order = (int)child_order[256u * test->octant + met];
    // Places 0, 1, 4, 5, then 2, 3, 6, 7: what unpacks two vectors takes halves of each half.
    const int8 slots = (int8)(order) >> (int8)(0, 4, 16, 20, 8, 12, 24, 28);
    const int8 child = __builtin_ia32_permvarsi256(as_int8(vload8(0, node->child)), slots);
    const int8 entry = as_int8(__builtin_ia32_permvarsf256(enter, slots));
    vstore8(__builtin_shufflevector(child, entry, 0, 8, 1, 9, 4, 12, 5, 13), 0, (int*)end);
    vstore8(__builtin_shufflevector(child, entry, 2, 10, 3, 11, 6, 14, 7, 15), 0, (int*)(end + 4));
    return end + popcount(met);
#else
    uint order = permute_by_octant(mask8_le(enter, leave), test->octant);
    while (order != 0u) {
        uint position = highest_lane(order);
        order ^= 1u << position;
        uint slot = position ^ test->octant;
        end->child = node->child[slot];
        end->entry = ((float*)&enter)[slot];
        ++end;
    }
    return end;
#endif
}

/// `t` within the box lo..hi; NaN becomes where the ray enters it. The planes go through the same
/// arithmetic as a node's, and fma is monotonic, so the result lies within every box around this
/// one: a flat primitive whose distance is kept to its own box is never culled wrongly, however
/// badly a grazing ray has defined that distance.
//
// Without looking at the ray's signs, which no branch predictor knows: fma() is monotonic, so the lesser of
// the two planes' results is that of the near plane.
#define SAHL_DEFINE_KEEP_TO_BOX(FLOAT)                                                                   \
    SAHL_OVERLOAD FLOAT keep_to_box(FLOAT t, const FLOAT* lo, const FLOAT* hi, const RayBoxTest* test) { \
        FLOAT nearest, farthest;                                                                         \
        _Pragma("unroll") for (uint k = 0; k < 3u; ++k) {                                                \
            FLOAT r = test->inverse[k], near = test->near_addend[k], far = test->far_addend[k];          \
            FLOAT enter_lo = fma(lo[k], r, near), enter_hi = fma(hi[k], r, near);                        \
            FLOAT leave_lo = fma(lo[k], r, far), leave_hi = fma(hi[k], r, far);                          \
            FLOAT enter = SAHL_MIN(enter_lo, enter_hi), leave = SAHL_MAX(leave_lo, leave_hi);            \
            nearest = k == 0u ? enter : SAHL_MAX(nearest, enter);                                        \
            farthest = k == 0u ? leave : SAHL_MIN(farthest, leave);                                      \
        }                                                                                                \
        t = t > nearest ? t : nearest;                                                                   \
        return t < farthest ? t : farthest;                                                              \
    }
SAHL_DEFINE_KEEP_TO_BOX(float)
SAHL_DEFINE_KEEP_TO_BOX(float4)

#endif
