// Ray intersection with discs, one ray against a block of four, each in its own object space:
// x² + y² <= 1, z = 0, front towards +z.
#ifndef SAHL_DISC_H
#define SAHL_DISC_H

#include "kernels/hit.h"
#include "kernels/quadric.h"

static inline void intersect_discs(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays r = object_rays(block, ray, 0.0f);
    float4 t = -r.pz / r.dz;
    float4 x = r.px + t * r.dx, y = r.py + t * r.dy;
    int4 inside = x * x + y * y <= 1.0f;
    t += r.shift;
    uint lanes = mask4(inside & (t <= state->t) & (t >= state->t_min));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        uint id = block->id[lane];
        if ((id & SAHL_ID_MASK) != ray->exclude && is_seen_from(id, ((float*)&r.dz)[lane] < 0.0f)) {
            offer_hit(state, ((float*)&t)[lane], 0.0f, 0.0f, id, any_hit);
        }
    }
}

#endif
