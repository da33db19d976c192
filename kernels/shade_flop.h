// Floating-point operations of shading, as count_visits.h counts them: of each of the SAHL_LANES lanes of a
// group, also of those that stand for nothing. What is computed once for a group is left out, and so are
// textures' (u, v).
#ifndef SAHL_SHADE_FLOP_H
#define SAHL_SHADE_FLOP_H

#include "kernels/count_visits.h"

#define SAHL_COUNT_LANES(shapes, flop) SAHL_COUNT(shapes, SAHL_COUNT_FLOP, SAHL_LANES*(flop))

// Of all groups: the background by the weight; by attenuation, for each material that a ray starts on.
#define SAHL_BACKGROUND_FLOP 3u
#define SAHL_FALLOFF_FLOP 9u

// Where anything is hit: the ray in full, position and offset, the side that is seen.
#define SAHL_HIT_FLOP (6u + 13u + 5u + 3u)
// In an instance: the ray there, the normals back.
#define SAHL_PLACED_FLOP (54u + 66u)

// For each material: what it emits.
#define SAHL_EMISSION_FLOP 6u

// A ray that is sent on: its origin, its weight, what floats lack of it.
#define SAHL_CHILD_FLOP (11u + 3u + 6u)

// Triangles' normals by those at their vertices.
#define SAHL_SMOOTH_FLOP 25u

/// Of surfaces of the kinds `present`, one bit each.
static inline uint surface_flop(uint present) {
    const uint plane = 14u, object = 127u, cone = 33u;
    const uint with_object = 1u << SAHL_KIND_ELLIPSOID | 1u << SAHL_KIND_DISC | 1u << SAHL_KIND_BOX |
                             1u << SAHL_KIND_CONE | 1u << SAHL_KIND_SOLID_CONE;
    uint flop = 0u;
    flop += present & 1u << SAHL_KIND_TRIANGLE ? 23u + plane : 0u;
    flop += present & 1u << SAHL_KIND_POLYGON ? 31u + plane : 0u;
    flop += present & 1u << SAHL_KIND_SPHERE ? 55u : 0u;
    flop += present & with_object ? object : 0u;
    flop += present & 1u << SAHL_KIND_DISC ? 12u : 0u;
    flop += present & 1u << SAHL_KIND_BOX ? 3u * 12u : 0u;
    flop += present & 1u << SAHL_KIND_CONE ? 1u + cone : 0u;
    flop += present & 1u << SAHL_KIND_SOLID_CONE ? 1u + 2u * 12u + 12u + cone : 0u;
    return flop;
}

/// Of a lamp's light on a material; `shines`: which has highlights.
static inline uint light_flop(const global DeviceLight* light, const global DeviceMaterial* material,
                              bool shines) {
    const uint power = 33u;
    uint flop = 22u;
    flop += light->kind == SAHL_LIGHT_DIRECTIONAL ? 0u : 11u;
    flop += light->kind == SAHL_LIGHT_SPOT ? 14u : 0u;
    flop += shines ? 6u + power + (material->flags & SAHL_MATERIAL_BLINN ? 14u : 12u) : 0u;
    return flop;
}

/// Of what a material sends on: Snell's law and the mirror's direction.
static inline uint scattering_flop(const global DeviceMaterial* material, bool reflects) {
    return (material->flags & SAHL_MATERIAL_TRANSMITS ? 37u : 0u) + (reflects ? 20u : 0u);
}

static inline uint texture_flop(const global DeviceTexture* texture) {
    return 3u + (texture->pattern == SAHL_PATTERN_GRADIENT ? 19u : 11u);
}

#endif
