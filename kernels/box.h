// Ray intersection with boxes, one ray against a block of four, each in its own object space:
// -1 <= x, y, z <= 1. The slab method (Kay and Kajiya 1986) on the ray moved to the point nearest the
// centre, so that nothing cancels for a far or small box.
#ifndef SAHL_BOX_H
#define SAHL_BOX_H

#include "kernels/hit.h"
#include "kernels/quadric.h"

/// From a slab's middle to its planes along the ray. A ray in parallel to them is between them all the
/// way or nowhere, in one of them too.
static inline float4 slab_half(float4 p, float4 d, float4 inverse) {
    float4 parallel = select((float4)(-INFINITY), (float4)(INFINITY), fabs(p) <= 1.0f);
    return select(fabs(inverse), parallel, d == 0.0f);
}

static inline void intersect_boxes(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.0f);
    float4 ix = finite_inverse4(r.dx), iy = finite_inverse4(r.dy), iz = finite_inverse4(r.dz);
    // From the slab's middle to its planes and back.
    float4 x = -r.px * ix, y = -r.py * iy, z = -r.pz * iz;
    float4 half_x = slab_half(r.px, r.dx, ix), half_y = slab_half(r.py, r.dy, iy);
    float4 half_z = slab_half(r.pz, r.dz, iz);
    float4 enter = SAHL_MAX(SAHL_MAX(x - half_x, y - half_y), z - half_z);
    float4 leave = SAHL_MIN(SAHL_MIN(x + half_x, y + half_y), z + half_z);
    // NaN (unused lanes) is no hit.
    enter = select((float4)(NAN), r.shift + enter, enter <= leave);
    offer_chords(state, enter, r.shift + leave, block->id, ray->exclude, any_hit);
}

#endif
