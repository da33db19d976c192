// Ray intersection with shapes that have object spaces of their own (QuadricBlock): ellipsoids, cones
// and cylinders, open or solid, discs and boxes, one ray against a block of four.
#ifndef SAHL_QUADRIC_H
#define SAHL_QUADRIC_H

#include "kernels/crossings.h"
#include "kernels/hit.h"
#include "kernels/simd.h"

static inline ObjectRays4 rays_in_block(const global QuadricBlock* block, const Ray* ray, float middle_z) {
    float4 m[9];
    for (uint k = 0; k < 9u; ++k) {
        m[k] = vload4(k, block->m[0]);
    }
    float4 ox = ray->origin.x - vload4(0, block->x);
    float4 oy = ray->origin.y - vload4(0, block->y);
    float4 oz = ray->origin.z - vload4(0, block->z);
    float3 d = ray->direction;
    return object_rays(m, ox, oy, oz, (float4)(d.x), (float4)(d.y), (float4)(d.z), middle_z);
}

static inline void intersect_ellipsoids(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                        bool any_hit) {
    ObjectRays4 r = rays_in_block(block, ray, 0.0f);
    Chords4 chords = ellipsoid_chords(&r);
    float4 half_chord = sqrt(chords.half_squared);
    offer_chords(state, chords.middle - half_chord, chords.middle + half_chord, block->id, ray->exclude,
                 any_hit);
}

static inline void intersect_cones(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays4 r = rays_in_block(block, ray, 0.5f);
    float4 enter, leave;
    int4 enter_valid, leave_valid;
    cross_cones(&r, vload4(0, block->slope), &enter, &leave, &enter_valid, &leave_valid);
    uint lanes = mask4((enter_valid & (enter <= state->t) & (enter >= state->t_min)) |
                       (leave_valid & (leave <= state->t) & (leave >= state->t_min)));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        offer_roots(state, ((float*)&enter)[lane], ((int*)&enter_valid)[lane] != 0, ((float*)&leave)[lane],
                    ((int*)&leave_valid)[lane] != 0, block->id[lane], ray->exclude, any_hit);
    }
}

static inline void intersect_solid_cones(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                         bool any_hit) {
    ObjectRays4 r = rays_in_block(block, ray, 0.5f);
    float4 enter, leave;
    cross_solid_cones(&r, vload4(0, block->slope), &enter, &leave);
    offer_chords(state, enter, leave, block->id, ray->exclude, any_hit);
}

static inline void intersect_boxes(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays4 r = rays_in_block(block, ray, 0.0f);
    float4 enter, leave;
    cross_boxes(&r, &enter, &leave);
    offer_chords(state, enter, leave, block->id, ray->exclude, any_hit);
}

/// The front of a disc is towards +z.
static inline void intersect_discs(const global QuadricBlock* block, const Ray* ray, HitState* state,
                                   bool any_hit) {
    ObjectRays4 r = rays_in_block(block, ray, 0.0f);
    int4 inside;
    float4 t = cross_discs(&r, &inside);
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
