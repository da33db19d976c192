// Watertight ray-triangle intersection, one ray against a block of four.
//
// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection": the vertices are sheared so
// that the ray runs along +z; the signs of three 2D edge functions decide. Rounded without
// contraction each edge function is right or zero, never of the wrong sign, so that tests which
// include zero leak nothing and need no double precision. The extent test rejects collinear
// triangles, which would be hit far along their line.
// What lies behind the ray's origin is left out at the same branch, as every ray that starts on a mesh
// crosses the triangle that it starts on: the interpolated depth says so, unless it is within its error.
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

/// Components axis, axis + 1 and axis + 2 (mod 3).
static inline float4 from_axis(float3 v, uint axis) {
    const float4 v4 = (float4)(v, 1.0f);
    const int4 is0 = (int4)(axis == 0u ? -1 : 0), is1 = (int4)(axis == 1u ? -1 : 0);
    return select(select(v4.zxyw, v4.yzxw, is1), v4, is0);
}

static inline RayShear ray_shear(float3 origin, float3 direction) {
    float3 a = fabs(direction);
    RayShear shear;
    shear.kz = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
    shear.kx = shear.kz == 2u ? 0u : shear.kz + 1u;
    shear.ky = shear.kx == 2u ? 0u : shear.kx + 1u;
    const float4 o = from_axis(origin, shear.kx), d = from_axis(direction, shear.kx);
    shear.ox = o.x;
    shear.oy = o.y;
    shear.oz = o.z;
    const float4 slopes = d / d.z;
    shear.sx = -slopes.x;
    shear.sy = -slopes.y;
    return shear;
}

/// Four triangles: the normals of their planes, from raw vertex differences and compensated, so that
/// slivers do as well as others, and their boxes.
typedef struct {
    float4 normal[3];
    float4 lo[3], hi[3];
} TrianglePlanes;

SAHL_INLINE TrianglePlanes triangle_planes(const global TriangleBlock* block) {
    TrianglePlanes planes;
    float4 e1[3], e2[3];
#pragma unroll
    for (uint k = 0; k < 3u; ++k) {
        const global float* axis = (const global float*)block + 16u * k;
        float4 a = vload4(0, axis), b = vload4(1, axis), c = vload4(2, axis);
        e1[k] = b - a;
        e2[k] = c - a;
        planes.lo[k] = SAHL_MIN(SAHL_MIN(a, b), c);
        planes.hi[k] = SAHL_MAX(SAHL_MAX(a, b), c);
    }
    planes.normal[0] = difference_of_products(e1[1], e2[2], e1[2], e2[1]);
    planes.normal[1] = difference_of_products(e1[2], e2[0], e1[0], e2[2]);
    planes.normal[2] = difference_of_products(e1[0], e2[1], e1[1], e2[0]);
    return planes;
}

SAHL_INLINE void intersect_triangles(const global TriangleBlock* block, const Ray* ray, const RayShear* shear,
                                     const RayBoxTest* boxes, HitState* state, bool any_hit) {
    const global float* axes = (const global float*)block;
    float16 z = vload16(shear->kz, axes) - shear->oz;
    float16 x = fma(z, (float16)(shear->sx), vload16(shear->kx, axes) - shear->ox);
    float16 y = fma(z, (float16)(shear->sy), vload16(shear->ky, axes) - shear->oy);

    // Groups of four lanes: w = e(v0, v1), u = e(v1, v2), v = e(v2, v0); the last group is junk.
    float16 edges = x.s456789ab0123cdef * y - y.s456789ab0123cdef * x;
    const float4 w = edges.s0123, u = edges.s4567, v = edges.s89ab;
    const float4 determinant = (u + v) + w;
    const float4 depth = fma(u, z.s0123, fma(v, z.s4567, w * z.s89ab));
    const int4 sign = (as_int4(determinant) ^ as_int(boxes->inverse[shear->kz])) & (int)0x80000000;
    const int4 ahead = as_float4(as_int4(depth) ^ sign) >= -block->depth_error[shear->kz];
    const float4 least = SAHL_MIN(SAHL_MIN(u, v), w), greatest = SAHL_MAX(SAHL_MAX(u, v), w);
    uint lanes = mask4(((least >= 0.0f) | (greatest <= 0.0f)) & ahead);
    if (lanes == 0u) {
        return;
    }
    TrianglePlanes planes = triangle_planes(block);
    float3 d = ray->direction, o = ray->origin;
    float4 nd = planes.normal[0] * d.x + planes.normal[1] * d.y + planes.normal[2] * d.z;
    float4 t =
        (planes.normal[0] * (vload4(0, block->x) - o.x) + planes.normal[1] * (vload4(0, block->y) - o.y) +
         planes.normal[2] * (vload4(0, block->z) - o.z)) /
        nd;
    t = keep_to_box(t, planes.lo, planes.hi, boxes);
    lanes &= mask4((t >= state->t_min) & (t <= state->t));
    if (lanes == 0u) {
        return;
    }
    uint reach = mask16_ge(x, (float16)(0.0f)) | mask16_ge(y, (float16)(0.0f)) << 16;
    uint back = mask16_le(x, (float16)(0.0f)) | mask16_le(y, (float16)(0.0f)) << 16;
    uint extent = (reach | reach >> 4 | reach >> 8) & (back | back >> 4 | back >> 8);
    lanes &= extent & extent >> 16 & mask4(determinant != 0.0f);
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        uint id = block->id[lane];
        if ((id & SAHL_ID_MASK) != ray->exclude && is_seen_from(id, ((float*)&nd)[lane] <= 0.0f)) {
            float scale = 1.0f / ((float*)&determinant)[lane];
            offer_hit(state, ((float*)&t)[lane], ((float*)&v)[lane] * scale, ((float*)&w)[lane] * scale, id,
                      any_hit);
        }
    }
}

#endif
