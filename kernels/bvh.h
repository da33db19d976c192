// The tree as a kernel sees it and the test of a ray against the eight children of a node.
//
// Boxes must never miss a primitive inside them. Near and far planes are chosen by the sign of the
// direction, and the fused multiply-add form t = plane·r - origin·r gets addends that are moved
// outward by e = (|origin| + extent)·2^-20·|r|, which covers its cancellation and the rounding of
// the primitives' own tests (0 misses where the plain form misses tens of thousands in a million
// degenerate rays).
#ifndef SAHL_BVH_H
#define SAHL_BVH_H

#include "kernels/device_types.h"
#include "kernels/math.h"
#include "kernels/simd.h"

typedef struct {
    const global BvhNode* nodes;
    const global uchar* leaves;
    const global float* polygon_vertices;
    const global DeviceInstance* instances;
    float extent;  // largest |coordinate| of the scene
} Bvh;

typedef struct {
    float3 inverse;  // 1/direction, finite
    float3 near_addend;
    float3 far_addend;
    uint near_x, near_y, near_z;  // which float8 of a node is the near plane
    uint octant;
} RayBoxTest;

/// 1/d, with ±1e18 for components that are (nearly) 0: 0·inf would be NaN.
static inline float finite_inverse(float d) { return 1.0f / (fabs(d) < 1e-18f ? copysign(1e-18f, d) : d); }

static inline RayBoxTest ray_box_test(float3 origin, float3 direction, float extent) {
    RayBoxTest test;
    float3 r =
        (float3)(finite_inverse(direction.x), finite_inverse(direction.y), finite_inverse(direction.z));
    float3 e = (fabs(origin) + extent) * 0x1p-20f * fabs(r);
    test.inverse = r;
    test.near_addend = -(origin * r) - e;
    test.far_addend = -(origin * r) + e;
    test.near_x = r.x < 0.0f ? 3u : 0u;
    test.near_y = r.y < 0.0f ? 4u : 1u;
    test.near_z = r.z < 0.0f ? 5u : 2u;
    test.octant = (r.x < 0.0f ? 1u : 0u) | (r.y < 0.0f ? 2u : 0u) | (r.z < 0.0f ? 4u : 0u);
    return test;
}

/// The children whose boxes the ray meets between t_min and t_max; *entry: where it enters each.
static inline uint intersect_children(const global BvhNode* node, const RayBoxTest* test, float t_min,
                                      float t_max, float8* entry) {
    const global float* planes = (const global float*)node;
    float3 r = test->inverse, n = test->near_addend, f = test->far_addend;
    float8 near_x = fma(vload8(test->near_x, planes), (float8)(r.x), (float8)(n.x));
    float8 near_y = fma(vload8(test->near_y, planes), (float8)(r.y), (float8)(n.y));
    float8 near_z = fma(vload8(test->near_z, planes), (float8)(r.z), (float8)(n.z));
    float8 far_x = fma(vload8(3u - test->near_x, planes), (float8)(r.x), (float8)(f.x));
    float8 far_y = fma(vload8(5u - test->near_y, planes), (float8)(r.y), (float8)(f.y));
    float8 far_z = fma(vload8(7u - test->near_z, planes), (float8)(r.z), (float8)(f.z));
    // No NaN comes here: rays are finite, r is finite and not 0, planes are finite or infinite.
    float8 enter = SAHL_MAX(SAHL_MAX(near_x, near_y), SAHL_MAX(near_z, (float8)(t_min)));
    float8 leave = SAHL_MIN(SAHL_MIN(far_x, far_y), SAHL_MIN(far_z, (float8)(t_max)));
    *entry = enter;
    return mask8_le(enter, leave);
}

/// `t` within the box lo..hi; NaN becomes where the ray enters it. The planes go through the same
/// arithmetic as a node's, and fma is monotonic, so the result lies within every box around this
/// one: a flat primitive whose distance is kept to its own box is never culled wrongly, however
/// badly a grazing ray has defined that distance.
static inline float keep_to_box(float t, float3 lo, float3 hi, const RayBoxTest* test) {
    bool forward_x = test->near_x == 0u, forward_y = test->near_y == 1u, forward_z = test->near_z == 2u;
    float3 entry_planes = (float3)(forward_x ? lo.x : hi.x, forward_y ? lo.y : hi.y, forward_z ? lo.z : hi.z);
    float3 exit_planes = (float3)(forward_x ? hi.x : lo.x, forward_y ? hi.y : lo.y, forward_z ? hi.z : lo.z);
    float3 enter = fma(entry_planes, test->inverse, test->near_addend);
    float3 leave = fma(exit_planes, test->inverse, test->far_addend);
    float nearest = SAHL_MAX(SAHL_MAX(enter.x, enter.y), enter.z);
    float farthest = SAHL_MIN(SAHL_MIN(leave.x, leave.y), leave.z);
    t = t > nearest ? t : nearest;
    return t < farthest ? t : farthest;
}

#endif
