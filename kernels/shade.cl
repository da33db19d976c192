// Hits -> light that needs no shadow test (ambient, emission, background), the light that each
// shadow ray would bring, and reflected and transmitted rays with their weights.

#include "kernels/light.h"
#include "kernels/material.h"
#include "kernels/ray_batch.h"
#include "kernels/surface.h"

/// The light of all lamps, each as if nothing were in between, into `light` (three arrays a lamp).
/// Returns how many bring any: their shadow rays are to be traced.
static inline uint shade_lights(const global DeviceLight* lights, uint light_count,
                                const global DeviceMaterial* material, float3 position, float3 ns, float3 wo,
                                float3 weight, global float* light, uint capacity, uint i) {
    uint shadow_rays = 0;
    for (uint l = 0; l < light_count; ++l) {
        float3 to_light = vector_to_light(lights + l, position);
        float distance = sqrt(dot3(to_light, to_light));
        float3 brought =
            phong_light(material, ns, to_light / distance, wo) * arriving_light(lights + l, distance);
        brought *= weight;
        shadow_rays += is_nonzero(brought);
        store_soa3(light, 3u * l, capacity, i, brought);
    }
    return shadow_rays;
}

/// What a hit sends on: `reflected` with weight kr, `transmitted` with weight kt; a weight of 0
/// stands for no ray.
typedef struct {
    real3 reflected, transmitted;
    float3 kr, kt;
} Scattering;

static inline Scattering scatter(const global DeviceMaterial* material, const Surface* surface, real3 ns,
                                 real3 facing, real3 d) {
    Scattering s;
    s.reflected = reflected_direction(d, ns);
    s.transmitted = d;
    s.kr = load3(material->reflection);
    s.kt = load3(material->transmission);
    if (material->flags & SAHL_MATERIAL_TRANSMITS) {
        real ior = material->ior;
        real eta = dot3_real(surface->ng, d) < (real)0 ? (real)1 / ior : ior;
        if (!refracted_direction(d, facing, eta, &s.transmitted)) {
            // Total internal reflection sends the transmitted light the mirror's way.
            s.kr += s.kt;
            s.kt = (float3)(0.0f);
        }
    }
    return s;
}

kernel void shade(const global DevicePrimitive* primitives, const global float* shape_data,
                  const global DeviceMaterial* materials, const global DeviceLight* lights,
                  const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                  const global float* hits, const global uint* hit_primitives, global float* contributions,
                  global uint* contribution_pixels, global float* shadow_surfaces, global float* shadow_light,
                  global float* children, global uint* child_ids, global uint* outcomes, const uint capacity,
                  const uint count, const uint spawn) {
    global float* transmitted_rays = children + (size_t)SAHL_RAY_FLOATS * capacity;
    global uint* transmitted_ids = child_ids + (size_t)SAHL_RAY_UINTS * capacity;
    SAHL_FOR_EACH_RAY(i, count) {
        const uint pixel = ray_ids[(size_t)SAHL_RAY_PIXEL * capacity + i];
        const float3 weight = load_soa3(rays, SAHL_RAY_WEIGHT, capacity, i);
        const uint primitive = hit_primitives[i];
        contribution_pixels[i] = pixel;
        if (primitive == SAHL_NO_PRIMITIVE) {
            store_soa3(contributions, 0u, capacity, i,
                       weight * (float3)(scene.background[0], scene.background[1], scene.background[2]));
            outcomes[i] = 0u;
            continue;
        }
        const real3 d = load_soa3_real(rays, SAHL_RAY_DIRECTION, SAHL_RAY_DIRECTION_LOW, capacity, i);
        const real3 origin = load_soa3_real(rays, SAHL_RAY_ORIGIN, SAHL_RAY_ORIGIN_LOW, capacity, i);
        const float3 hit = load_soa3(hits, SAHL_HIT_T, capacity, i);
        const Surface surface = surface_at(primitives, shape_data, primitive, origin, d, hit.x, hit.y, hit.z);
        const global DeviceMaterial* material = materials + surface.material;
        const real3 facing = dot3_real(surface.ns, d) > (real)0 ? -surface.ns : surface.ns;
        const real3 ns = material->flags & SAHL_MATERIAL_TWO_SIDED ? facing : surface.ns;
        const float3 position = round3(surface.position);
        const float3 offset = round3(surface.ng) * surface.offset;

        store_soa3(contributions, 0u, capacity, i, weight * load3(material->emitted));
        store_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i, position);
        store_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i, offset);
        uint outcome =
            SAHL_OUTCOME_SHADOW_RAY * shade_lights(lights, scene.light_count, material, position, round3(ns),
                                                   round3(-d), weight, shadow_light, capacity, i);
        if (spawn) {
            const Scattering s = scatter(material, &surface, ns, facing, d);
            if (is_nonzero(s.kr)) {
                store_ray(children, child_ids, capacity, i,
                          offset_origin(position, offset, round3(s.reflected)), surface.position, s.reflected,
                          primitive, weight * s.kr, pixel);
                outcome |= SAHL_OUTCOME_REFLECTED;
            }
            if (is_nonzero(s.kt)) {
                store_ray(transmitted_rays, transmitted_ids, capacity, i,
                          offset_origin(position, offset, round3(s.transmitted)), surface.position,
                          s.transmitted, primitive, weight * s.kt, pixel);
                outcome |= SAHL_OUTCOME_TRANSMITTED;
            }
        }
        outcomes[i] = outcome;
    }
}
