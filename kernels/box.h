// Ray intersection with boxes, one ray against a block of four, each in its own object space:
// -1 <= x, y, z <= 1. The slab method (Kay and Kajiya 1986) on the ray moved to the point nearest the
// centre, so that nothing cancels for a far or small box.
#ifndef SAHL_BOX_H
#define SAHL_BOX_H

#include "kernels/hit.h"
#include "kernels/quadric.h"

static inline void intersect_boxes(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.0f);
    float4 ix = finite_inverse4(r.dx), iy = finite_inverse4(r.dy), iz = finite_inverse4(r.dz);
    // From the slab's middle to its planes and back.
    float4 x = -r.px * ix, y = -r.py * iy, z = -r.pz * iz;
    float4 half_x = fabs(ix), half_y = fabs(iy), half_z = fabs(iz);
    float4 enter = SAHL_MAX(SAHL_MAX(x - half_x, y - half_y), z - half_z);
    float4 leave = SAHL_MIN(SAHL_MIN(x + half_x, y + half_y), z + half_z);
    // NaN (unused lanes) is no hit.
    enter = select((float4)(NAN), r.shift + enter, enter <= leave);
    offer_chords(state, enter, r.shift + leave, block->id, ray->exclude, any_hit);
}

#endif
