// Ray intersection with ellipsoids and open cones (cylinders among them), one ray against a block
// of four, each in its own object space: the unit sphere, or x² + y² = (1 + slope z)², 0 <= z <= 1.
//
// The ray is first moved to the point nearest the object (as Haines et al. do for the sphere, Ray
// Tracing Gems ch. 7), so that nothing cancels for a far or small one. There the cone's discriminant
// is written as a sum of squares less a square, |w d - w' p|² - (p × d)² over x and y with
// w = 1 + slope z, in which the product p²d² of b² - ac is already gone; and the roots come from
// q = -(b ± s) so that neither is a difference of near numbers.
#ifndef SAHL_QUADRIC_H
#define SAHL_QUADRIC_H

#include "kernels/hit.h"
#include "kernels/simd.h"

/// Four rays in four object spaces, from the points nearest the objects' middles; `shift` is how
/// far along the ray that is.
typedef struct {
    float4 px, py, pz;
    float4 dx, dy, dz;
    float4 inverse_dd;
    float4 shift;
} ObjectRays;

static inline ObjectRays object_rays(const global QuadricBlock* block, const Ray* ray, float middle_z) {
    float4 ox = ray->origin.x - vload4(0, block->x);
    float4 oy = ray->origin.y - vload4(0, block->y);
    float4 oz = ray->origin.z - vload4(0, block->z);
    float3 d = ray->direction;
    const global float* m = block->m[0];
    ObjectRays r;
    float4 px = vload4(0, m) * ox + vload4(1, m) * oy + vload4(2, m) * oz;
    float4 py = vload4(3, m) * ox + vload4(4, m) * oy + vload4(5, m) * oz;
    float4 pz = vload4(6, m) * ox + vload4(7, m) * oy + vload4(8, m) * oz;
    r.dx = vload4(0, m) * d.x + vload4(1, m) * d.y + vload4(2, m) * d.z;
    r.dy = vload4(3, m) * d.x + vload4(4, m) * d.y + vload4(5, m) * d.z;
    r.dz = vload4(6, m) * d.x + vload4(7, m) * d.y + vload4(8, m) * d.z;
    r.inverse_dd = 1.0f / (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    r.shift = -(px * r.dx + py * r.dy + (pz - middle_z) * r.dz) * r.inverse_dd;
    r.px = px + r.shift * r.dx;
    r.py = py + r.shift * r.dy;
    r.pz = pz + r.shift * r.dz;
    return r;
}

static inline void intersect_ellipsoids(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                        bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.0f);
    float4 half_chord = sqrt((1.0f - (r.px * r.px + r.py * r.py + r.pz * r.pz)) * r.inverse_dd);
    offer_chords(state, r.shift - half_chord, r.shift + half_chord, block->id, ray->exclude, any_hit);
}

static inline void intersect_cones(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.5f);
    float4 slope = vload4(0, block->slope);
    float4 w = 1.0f + slope * r.pz, wd = slope * r.dz;
    float4 ex = w * r.dx - wd * r.px, ey = w * r.dy - wd * r.py;
    float4 turn = r.px * r.dy - r.py * r.dx;
    float4 s = sqrt(ex * ex + ey * ey - turn * turn);
    float4 a = r.dx * r.dx + r.dy * r.dy - wd * wd;
    float4 b = r.px * r.dx + r.py * r.dy - w * wd;
    float4 radius = sqrt(r.px * r.px + r.py * r.py);
    float4 c = (radius - w) * (radius + w);
    float4 q = -(b + copysign(s, b));
    float4 first = q / a, second = c / q;
    // (-b - s)/a is where x² + y² - w² falls, the entering root, whatever the sign of a.
    // `first` is that one where b has no sign bit; select() looks at just that bit.
    float4 enter = select(first, second, as_int4(b)), leave = select(second, first, as_int4(b));
    float4 enter_z = r.pz + enter * r.dz, leave_z = r.pz + leave * r.dz;
    int4 enter_valid = (enter_z >= 0.0f) & (enter_z <= 1.0f);
    int4 leave_valid = (leave_z >= 0.0f) & (leave_z <= 1.0f);
    enter += r.shift;
    leave += r.shift;
    uint lanes = mask4((enter_valid & (enter <= state->t) & (enter >= state->t_min)) |
                       (leave_valid & (leave <= state->t) & (leave >= state->t_min)));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        offer_roots(state, ((float*)&enter)[lane], ((int*)&enter_valid)[lane] != 0, ((float*)&leave)[lane],
                    ((int*)&leave_valid)[lane] != 0, block->id[lane], ray->exclude, any_hit);
    }
}

#endif
