// Ray-sphere intersection, one ray against a block of four.
#ifndef SAHL_SPHERE_H
#define SAHL_SPHERE_H

#include "kernels/crossings.h"
#include "kernels/hit.h"

static inline void intersect_spheres(const global SphereBlock* block, const Ray* ray, HitState* state,
                                     bool any_hit) {
    float3 d = ray->direction;
    float4 cx = vload4(0, block->x) - ray->origin.x;
    float4 cy = vload4(0, block->y) - ray->origin.y;
    float4 cz = vload4(0, block->z) - ray->origin.z;
    Chords4 chords = sphere_chords(cx, cy, cz, vload4(0, block->radius), (float4)(d.x), (float4)(d.y),
                                   (float4)(d.z), (float4)(1.0f / dot3(d, d)));
    float4 half_chord = sqrt(chords.half_squared);
    offer_chords(state, chords.middle - half_chord, chords.middle + half_chord, block->id, ray->exclude,
                 any_hit);
}

#endif
