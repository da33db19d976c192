// Watertight ray-triangle intersection, one ray against a block of four.
//
// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection": the vertices are sheared so
// that the ray runs along +z; the signs of three 2D edge functions decide. Rounded without
// contraction each edge function is right or zero, never of the wrong sign, so that tests which
// include zero leak nothing and need no double precision. The extent test rejects collinear
// triangles, which would be hit far along their line.
// The interpolated distance is poor on slivers; t comes from the plane instead, kept to the
// triangle's own box, which it leaves when the ray lies (nearly) in the plane.
#ifndef SAHL_TRIANGLE_H
#define SAHL_TRIANGLE_H

#include "kernels/bvh.h"
#include "kernels/hit.h"
#include "kernels/simd.h"

/// The shear that a ray applies to vertices: axis k.z is the largest of |direction| (ties x, y, z).
typedef struct {
    uint kx, ky, kz;   // axes
    float ox, oy, oz;  // origin along them
    float sx, sy;      // minus the shear factors
} RayShear;

static inline float component(float3 v, uint axis) { return axis == 0u ? v.x : (axis == 1u ? v.y : v.z); }

static inline RayShear ray_shear(float3 origin, float3 direction) {
    float3 a = fabs(direction);
    RayShear shear;
    shear.kz = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
    shear.kx = shear.kz == 2u ? 0u : shear.kz + 1u;
    shear.ky = shear.kx == 2u ? 0u : shear.kx + 1u;
    shear.ox = component(origin, shear.kx);
    shear.oy = component(origin, shear.ky);
    shear.oz = component(origin, shear.kz);
    float dz = component(direction, shear.kz);
    shear.sx = -(component(direction, shear.kx) / dz);
    shear.sy = -(component(direction, shear.ky) / dz);
    return shear;
}

static inline void intersect_triangles(const global TriangleBlock* block, const Ray* ray,
                                       const RayShear* shear, const RayBoxTest* boxes, HitState* state,
                                       bool any_hit) {
    const global float* axes = (const global float*)block;
    float16 z = vload16(shear->kz, axes) - shear->oz;
    float16 x = fma(z, (float16)(shear->sx), vload16(shear->kx, axes) - shear->ox);
    float16 y = fma(z, (float16)(shear->sy), vload16(shear->ky, axes) - shear->oy);

    // Groups of four lanes: w = e(v0, v1), u = e(v1, v2), v = e(v2, v0); the last group is junk.
    float16 edges = x.s456789ab0123cdef * y - y.s456789ab0123cdef * x;
    uint positive = mask16_ge(edges, (float16)(0.0f));
    uint negative = mask16_le(edges, (float16)(0.0f));
    uint lanes =
        ((positive & positive >> 4 & positive >> 8) | (negative & negative >> 4 & negative >> 8)) & 15u;
    if (lanes == 0u) {
        return;
    }
    float4 w = edges.s0123, u = edges.s4567, v = edges.s89ab;
    float4 determinant = (u + v) + w;
    uint reach_x = mask16_ge(x, (float16)(0.0f)), reach_y = mask16_ge(y, (float16)(0.0f));
    uint back_x = mask16_le(x, (float16)(0.0f)), back_y = mask16_le(y, (float16)(0.0f));
    uint extent = (reach_x | reach_x >> 4 | reach_x >> 8) & (back_x | back_x >> 4 | back_x >> 8) &
                  (reach_y | reach_y >> 4 | reach_y >> 8) & (back_y | back_y >> 4 | back_y >> 8);
    lanes &= extent & mask4(determinant != 0.0f);

    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        uint id = block->id[lane];
        if ((id & SAHL_ID_MASK) == ray->exclude) {
            continue;
        }
        float3 v0 = (float3)(block->x[lane], block->y[lane], block->z[lane]);
        float3 v1 = (float3)(block->x[4 + lane], block->y[4 + lane], block->z[4 + lane]);
        float3 v2 = (float3)(block->x[8 + lane], block->y[8 + lane], block->z[8 + lane]);
        // The plane's normal from raw vertex differences, compensated: slivers do as well as others.
        float3 normal = accurate_cross3(v1 - v0, v2 - v0);
        float nd = dot3(normal, ray->direction);
        if (!is_seen_from(id, nd <= 0.0f)) {
            continue;
        }
        float t = keep_to_box(dot3(normal, v0 - ray->origin) / nd, min3(min3(v0, v1), v2),
                              max3(max3(v0, v1), v2), boxes);
        float scale = 1.0f / ((float*)&determinant)[lane];
        offer_hit(state, t, ((float*)&v)[lane] * scale, ((float*)&w)[lane] * scale, id, any_hit);
    }
}

#endif
