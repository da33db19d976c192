// Ray-sphere intersection, one ray against a block of four.
//
// Haines, Günther, Akenine-Möller 2019, "Precision Improvements for Ray/Sphere Intersection" (Ray
// Tracing Gems, ch. 7): the discriminant from the distance of the centre to the ray, which does
// not cancel for small or far spheres as B² - AC does.
#ifndef SAHL_SPHERE_H
#define SAHL_SPHERE_H

#include "kernels/hit.h"

static inline void intersect_spheres(const global SphereBlock* block, const Ray* ray, HitState* state,
                                     bool any_hit) {
    float3 d = ray->direction;
    float inverse_dd = 1.0f / dot3(d, d);
    float4 cx = vload4(0, block->x) - ray->origin.x;
    float4 cy = vload4(0, block->y) - ray->origin.y;
    float4 cz = vload4(0, block->z) - ray->origin.z;
    float4 radius = vload4(0, block->radius);
    float4 middle = (cx * d.x + cy * d.y + cz * d.z) * inverse_dd;
    float4 lx = cx - middle * d.x, ly = cy - middle * d.y, lz = cz - middle * d.z;
    float4 half_chord = sqrt((radius * radius - (lx * lx + ly * ly + lz * lz)) * inverse_dd);
    offer_chords(state, middle - half_chord, middle + half_chord, block->id, ray->exclude, any_hit);
}

#endif
