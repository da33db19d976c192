// Hits -> light that needs no shadow test (ambient, emission, background), the light that each
// shadow ray would bring, and reflected and transmitted rays with their weights.

#include "kernels/light.h"
#include "kernels/material.h"
#include "kernels/ray_batch.h"
#include "kernels/surface.h"

/// The light of all lamps, each as if nothing were in between, into `light` (three arrays a lamp).
/// Returns how many bring any: their shadow rays are to be traced.
static inline uint shade_lights(const global DeviceLight* lights, uint light_count, const global DeviceMaterial* material,
                         const Surface* surface, float3 ns, float3 wo, float3 weight, global float* light,
                         uint capacity, uint i) {
    uint shadow_rays = 0;
    for (uint l = 0; l < light_count; ++l) {
        float3 to_light = vector_to_light(lights + l, surface->position);
        float distance = sqrt(dot3(to_light, to_light));
        float3 brought = phong_light(material, ns, to_light / distance, wo) * arriving_light(lights + l, distance);
        brought *= weight;
        shadow_rays += brought.x != 0.0f || brought.y != 0.0f || brought.z != 0.0f;
        store_soa3(light, 3u * l, capacity, i, brought);
    }
    return shadow_rays;
}

kernel void shade(const global DevicePrimitive* primitives, const global float* shape_data,
                  const global DeviceMaterial* materials, const global DeviceLight* lights, const SceneConstants scene,
                  const global float* rays, const global uint* ray_ids, const global float* hits,
                  const global uint* hit_primitives, global float* contributions, global uint* contribution_pixels,
                  global float* shadow_surfaces, global float* shadow_light, global float* children,
                  global uint* child_ids, global uint* outcomes, const uint capacity, const uint count,
                  const uint spawn) {
    const size_t child_floats = (size_t)SAHL_RAY_FLOATS * capacity, child_uints = (size_t)SAHL_RAY_UINTS * capacity;
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
        const float3 d = load_soa3(rays, SAHL_RAY_DIRECTION, capacity, i);
        const float3 hit = load_soa3(hits, SAHL_HIT_T, capacity, i);
        const Surface surface = surface_at(primitives, shape_data, primitive,
                                           load_soa3(rays, SAHL_RAY_ORIGIN, capacity, i), d, hit.x, hit.y, hit.z);
        const global DeviceMaterial* material = materials + surface.material;
        const float3 facing = dot3(surface.ns, d) > 0.0f ? -surface.ns : surface.ns;
        const float3 ns = material->flags & SAHL_MATERIAL_TWO_SIDED ? facing : surface.ns;

        store_soa3(contributions, 0u, capacity, i, weight * load3(material->emitted));
        store_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i, surface.position);
        store_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i, surface.offset);
        uint outcome = SAHL_OUTCOME_SHADOW_RAY * shade_lights(lights, scene.light_count, material, &surface, ns, -d,
                                                              weight, shadow_light, capacity, i);
        if (spawn) {
            float3 kr = load3(material->reflection);
            if (material->flags & SAHL_MATERIAL_TRANSMITS) {
                float eta = dot3(surface.ng, d) < 0.0f ? 1.0f / material->ior : material->ior;
                float3 refracted;
                if (refracted_direction(d, facing, eta, &refracted)) {
                    Ray child = {offset_origin(surface.position, surface.offset, refracted), refracted,
                                 primitive};
                    store_ray(children + child_floats, child_ids + child_uints, capacity, i, child,
                              weight * load3(material->transmission), pixel);
                    outcome |= SAHL_OUTCOME_TRANSMITTED;
                } else {
                    // Total internal reflection sends the transmitted light the mirror's way.
                    kr += load3(material->transmission);
                }
            }
            if (kr.x != 0.0f || kr.y != 0.0f || kr.z != 0.0f) {
                float3 reflected = reflected_direction(d, ns);
                Ray child = {offset_origin(surface.position, surface.offset, reflected), reflected,
                             primitive};
                store_ray(children, child_ids, capacity, i, child, weight * kr, pixel);
                outcome |= SAHL_OUTCOME_REFLECTED;
            }
        }
        outcomes[i] = outcome;
    }
}
