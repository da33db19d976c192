// Ray intersection with ellipsoids and cones (cylinders among them), open or solid, one ray against
// a block of four, each in its own object space: the unit sphere, or x² + y² = (1 + slope z)²,
// 0 <= z <= 1.
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

/// 1/d, with ±1e18 for components that are (nearly) 0: 0·inf would be NaN.
static inline float4 finite_inverse4(float4 d) {
    return 1.0f / select(d, copysign((float4)(1e-18f), d), fabs(d) < 1e-18f);
}

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

/// Where x² + y² - (1 + slope z)² falls below 0 (`enter`) and rises above it (`leave`) along rays.
/// `growth` is its leading coefficient: where that is negative, leave < enter.
typedef struct {
    float4 enter, leave;
    float4 growth;
} ConeRoots;

static inline ConeRoots cone_roots(const ObjectRays* r, float4 slope) {
    float4 w = 1.0f + slope * r->pz, wd = slope * r->dz;
    float4 ex = w * r->dx - wd * r->px, ey = w * r->dy - wd * r->py;
    float4 turn = r->px * r->dy - r->py * r->dx;
    float4 a = r->dx * r->dx + r->dy * r->dy - wd * wd;
    float4 discriminant = ex * ex + ey * ey - turn * turn;
    // A steep ray always has roots, however near it passes the apex.
    float4 s = sqrt(select(discriminant, SAHL_MAX(discriminant, 0.0f), a <= 0.0f));
    float4 b = r->px * r->dx + r->py * r->dy - w * wd;
    float4 radius = sqrt(r->px * r->px + r->py * r->py);
    float4 c = (radius - w) * (radius + w);
    float4 q = -(b + copysign(s, b));
    float4 first = q / a, second = c / q;
    // (-b - s)/a is the entering root, whatever the sign of a. `first` is that one where b has no
    // sign bit; select() looks at just that bit.
    ConeRoots roots;
    roots.enter = select(first, second, as_int4(b));
    roots.leave = select(second, first, as_int4(b));
    roots.growth = a;
    return roots;
}

static inline void intersect_cones(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.5f);
    ConeRoots roots = cone_roots(&r, vload4(0, block->slope));
    float4 enter = roots.enter, leave = roots.leave;
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

/// The solid that cone and caps enclose: where the ray is inside of both the cone and 0 <= z <= 1, in
/// one piece, so that nothing leaks where a cap meets the side.
static inline void intersect_solid_cones(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                         bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.5f);
    float4 slope = vload4(0, block->slope);
    float4 wd = slope * r.dz;
    ConeRoots roots = cone_roots(&r, slope);
    // A ray steeper than the side is inside both halves of the double cone, in one of them before it
    // leaves and in the other from where it enters; the caps bound the half in which w = 1 + slope z
    // grows along the ray's way in or shrinks on its way out. Without such a root there is nothing.
    int4 steep = roots.growth <= 0.0f;
    float4 first = select(roots.enter, (float4)(-INFINITY), steep & ~(wd > 0.0f));
    float4 last = select(roots.leave, (float4)(INFINITY), steep & (wd > 0.0f));
    first = select(first, (float4)(INFINITY), steep & (wd > 0.0f) & isinf(first));
    last = select(last, (float4)(-INFINITY), steep & (wd < 0.0f) & isinf(last));
    // Along a cylinder's axis it is inside all the way or nowhere.
    int4 along = (wd == 0.0f) & (r.dx == 0.0f) & (r.dy == 0.0f);
    float4 beside = select((float4)(INFINITY), (float4)(-INFINITY), r.px * r.px + r.py * r.py <= 1.0f);
    first = select(first, beside, along);
    last = select(last, (float4)(INFINITY), along);

    float4 inverse = finite_inverse4(r.dz);
    float4 bottom = -r.pz * inverse, top = (1.0f - r.pz) * inverse;
    float4 enter = SAHL_MAX(first, SAHL_MIN(bottom, top));
    float4 leave = SAHL_MIN(last, SAHL_MAX(bottom, top));
    // The comparisons are false for NaN, which stands for a missed side.
    int4 hit = (enter <= leave) & (first <= last);
    enter = select((float4)(NAN), r.shift + enter, hit);
    offer_chords(state, enter, r.shift + leave, block->id, ray->exclude, any_hit);
}

#endif
