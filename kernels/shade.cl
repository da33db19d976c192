// Hits -> light that needs no shadow test (ambient, emission, background), the light that each
// shadow ray would bring, and reflected and transmitted rays with their weights.

#include "kernels/light.h"
#include "kernels/material.h"
#include "kernels/ray_batch.h"
#include "kernels/surface.h"
#include "kernels/texture.h"

/// The light of all lamps, each as if nothing were in between, into `light` (three arrays a lamp).
/// Returns how many bring any: their shadow rays are to be traced.
static inline uint shade_lights(const global DeviceLight* lights, uint light_count,
                                const global DeviceMaterial* material, const SurfaceColors* colors,
                                float3 position, float3 ns, float3 wo, float3 weight, global float* light,
                                uint capacity, uint i) {
    uint shadow_rays = 0;
    for (uint l = 0; l < light_count; ++l) {
        float3 to_light = vector_to_light(lights + l, position);
        float distance = sqrt(dot3(to_light, to_light));
        float3 wi = to_light / distance;
        float3 brought = phong_light(material, colors->diffuse, colors->specular, ns, wi, wo) *
                         arriving_light(lights + l, wi, distance);
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

static inline Scattering scatter(const global DeviceMaterial* material, float3 reflection,
                                 const Surface* surface, real3 ns, real3 facing, real3 d) {
    Scattering s;
    s.reflected = reflected_direction(d, ns);
    s.transmitted = d;
    s.kr = reflection;
    s.kt = load3(material->transmission);
    if (material->flags & SAHL_MATERIAL_TRANSMITS) {
        real ior = material->ior, outside = material->ior_outside;
        real eta = dot3_real(surface->ng, d) < (real)0 ? outside / ior : ior / outside;
        if (!refracted_direction(d, facing, eta, &s.transmitted)) {
            // Total internal reflection sends the transmitted light the mirror's way.
            s.kr += s.kt;
            s.kt = (float3)(0.0f);
        }
    }
    return s;
}

/// The weight of a ray's light, which `distance` may have attenuated on its way to where the ray starts.
static inline float3 attenuated_weight(const Shapes* shapes, const global DeviceMaterial* materials,
                                       float3 weight, uint start, float distance) {
    if (!(start & SAHL_RAY_ATTENUATED)) {
        return weight;
    }
    uint material = shapes->primitives[start & SAHL_ID_MASK].material;
    return weight * reflection_falloff(materials + material, distance);
}

kernel void shade(const global DevicePrimitive* primitives, const global float* shape_data,
                  const global DeviceInstance* instances, const global DeviceMaterial* materials,
                  const global DeviceTexture* textures, const global DeviceLight* lights,
                  const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                  const global float* hits, const global uint* hit_ids, global float* contributions,
                  global uint* contribution_pixels, global float* shadow_surfaces, global float* shadow_light,
                  global float* children, global uint* child_ids, global uint* outcomes, const uint capacity,
                  const uint count, const uint spawn) {
    const Shapes shapes = {primitives, shape_data, instances};
    global float* transmitted_rays = children + (size_t)SAHL_RAY_FLOATS * capacity;
    global uint* transmitted_ids = child_ids + (size_t)SAHL_RAY_UINTS * capacity;
    SAHL_FOR_EACH_RAY(i, count) {
        const uint pixel = ray_ids[(size_t)SAHL_RAY_PIXEL * capacity + i];
        const uint primitive = hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i];
        const uint instance = hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i];
        const float3 hit = load_soa3(hits, SAHL_HIT_T, capacity, i);
        const float3 weight =
            attenuated_weight(&shapes, materials, load_soa3(rays, SAHL_RAY_WEIGHT, capacity, i),
                              ray_ids[(size_t)SAHL_RAY_EXCLUDE * capacity + i], hit.x);
        contribution_pixels[i] = pixel;
        if (primitive == SAHL_NO_PRIMITIVE) {
            store_soa3(contributions, 0u, capacity, i,
                       weight * (float3)(scene.background[0], scene.background[1], scene.background[2]));
            outcomes[i] = 0u;
            continue;
        }
        const real3 d = load_soa3_real(rays, SAHL_RAY_DIRECTION, SAHL_RAY_DIRECTION_LOW, capacity, i);
        const real3 origin = load_soa3_real(rays, SAHL_RAY_ORIGIN, SAHL_RAY_ORIGIN_LOW, capacity, i);
        const Surface surface = surface_at(&shapes, instance, primitive, origin, d, hit.x, hit.y, hit.z);
        const global DeviceMaterial* material = materials + surface.material;
        const real3 facing = dot3_real(surface.ns, d) > (real)0 ? -surface.ns : surface.ns;
        const real3 ns = material->flags & SAHL_MATERIAL_TWO_SIDED ? facing : surface.ns;
        const SurfaceColors colors = surface_colors(&shapes, material, textures, &surface, primitive);
        const float3 position = round3(surface.position);
        const float3 offset = round3(surface.ng) * surface.offset;

        store_soa3(contributions, 0u, capacity, i, weight * colors.emitted);
        store_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i, position);
        store_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i, offset);
        uint outcome =
            SAHL_OUTCOME_SHADOW_RAY * shade_lights(lights, scene.light_count, material, &colors, position,
                                                   round3(ns), round3(-d), weight, shadow_light, capacity, i);
        if (spawn) {
            const Scattering s = scatter(material, colors.reflection, &surface, ns, facing, d);
            if (is_nonzero(s.kr)) {
                store_ray(children, child_ids, capacity, i,
                          offset_origin(position, offset, round3(s.reflected)), surface.position, s.reflected,
                          primitive | (material->flags & SAHL_MATERIAL_ATTENUATES ? SAHL_RAY_ATTENUATED : 0u),
                          instance, weight * s.kr, pixel);
                outcome |= SAHL_OUTCOME_REFLECTED;
            }
            if (is_nonzero(s.kt)) {
                store_ray(transmitted_rays, transmitted_ids, capacity, i,
                          offset_origin(position, offset, round3(s.transmitted)), surface.position,
                          s.transmitted, primitive, instance, weight * s.kt, pixel);
                outcome |= SAHL_OUTCOME_TRANSMITTED;
            }
        }
        outcomes[i] = outcome;
    }
}
