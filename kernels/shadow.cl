// Shadow rays -> the light that arrives, added to their hits' contributions in the order of the
// lights.

#include "kernels/light.h"
#include "kernels/ray_batch.h"
#include "kernels/surface.h"
#include "kernels/traverse_scalar.h"

/// The part of the light that comes through along `ray` up to t_max: 0 behind an opaque surface,
/// else the product of the transmissions of the surfaces in between, each crossing once, in order.
static inline float3 transmittance(const Bvh* bvh, const global DevicePrimitive* primitives,
                                   const global DeviceMaterial* materials, const Ray* ray, float t_max) {
    uint occlusion = any_hit(bvh, ray, t_max);
    if (occlusion != SAHL_HIT_TRANSPARENT) {
        return (float3)(occlusion == SAHL_HIT_NOTHING ? 1.0f : 0.0f);
    }
    float3 through = (float3)(1.0f);
    HitState hit = closest_hit(bvh, ray, hit_state(0.0f, t_max));
    while (hit.primitive != SAHL_NO_PRIMITIVE) {
        through *= load3(materials[primitives[hit.primitive].material].transmission);
        hit = closest_hit(bvh, ray, hit_state_behind(hit, t_max));
    }
    return through;
}

kernel void shadow_scalar(const global BvhNode* nodes, const global uchar* leaves,
                          const global float* polygon_vertices, const global DeviceInstance* instances,
                          const global DevicePrimitive* primitives, const global DeviceMaterial* materials,
                          const global DeviceLight* lights, const SceneConstants scene,
                          const global uint* hit_ids, const global float* shadow_surfaces,
                          const global float* shadow_light, const global uint* outcomes,
                          global float* contributions, const uint capacity, const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        if (outcomes[i] < SAHL_OUTCOME_SHADOW_RAY) {
            continue;
        }
        const float3 position = load_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i);
        const float3 offset = load_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i);
        float3 sum = load_soa3(contributions, 0u, capacity, i);
        for (uint l = 0; l < scene.light_count; ++l) {
            float3 brought = load_soa3(shadow_light, 3u * l, capacity, i);
            if (!is_nonzero(brought)) {
                continue;
            }
            float3 side = vector_to_light(lights + l, position);
            Ray ray;
            ray.origin = offset_origin(position, offset, side);
            ray.direction = vector_to_light(lights + l, ray.origin);
            ray.exclude = hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i];
            ray.instance = hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i];
            sum += brought * transmittance(&bvh, primitives, materials, &ray, shadow_t_max(lights + l));
        }
        store_soa3(contributions, 0u, capacity, i, sum);
    }
}

kernel void shadow_packet(const global BvhNode* nodes, const global uchar* leaves,
                          const global float* polygon_vertices, const global DeviceInstance* instances,
                          const global DevicePrimitive* primitives, const global DeviceMaterial* materials,
                          const global DeviceLight* lights, const SceneConstants scene,
                          const global uint* hit_ids, const global float* shadow_surfaces,
                          const global float* shadow_light, const global uint* outcomes,
                          global float* contributions, const uint capacity, const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        if (outcomes[i] < SAHL_OUTCOME_SHADOW_RAY) {
            continue;
        }
        const float3 position = load_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i);
        const float3 offset = load_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i);
        float3 sum = load_soa3(contributions, 0u, capacity, i);
        for (uint l = 0; l < scene.light_count; ++l) {
            float3 brought = load_soa3(shadow_light, 3u * l, capacity, i);
            if (!is_nonzero(brought)) {
                continue;
            }
            float3 side = vector_to_light(lights + l, position);
            Ray ray;
            ray.origin = offset_origin(position, offset, side);
            ray.direction = vector_to_light(lights + l, ray.origin);
            ray.exclude = hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i];
            ray.instance = hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i];
            sum += brought * transmittance(&bvh, primitives, materials, &ray, shadow_t_max(lights + l));
        }
        store_soa3(contributions, 0u, capacity, i, sum);
    }
}

kernel void shadow_stream(const global BvhNode* nodes, const global uchar* leaves,
                          const global float* polygon_vertices, const global DeviceInstance* instances,
                          const global DevicePrimitive* primitives, const global DeviceMaterial* materials,
                          const global DeviceLight* lights, const SceneConstants scene,
                          const global uint* hit_ids, const global float* shadow_surfaces,
                          const global float* shadow_light, const global uint* outcomes,
                          global float* contributions, const uint capacity, const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        if (outcomes[i] < SAHL_OUTCOME_SHADOW_RAY) {
            continue;
        }
        const float3 position = load_soa3(shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i);
        const float3 offset = load_soa3(shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i);
        float3 sum = load_soa3(contributions, 0u, capacity, i);
        for (uint l = 0; l < scene.light_count; ++l) {
            float3 brought = load_soa3(shadow_light, 3u * l, capacity, i);
            if (!is_nonzero(brought)) {
                continue;
            }
            float3 side = vector_to_light(lights + l, position);
            Ray ray;
            ray.origin = offset_origin(position, offset, side);
            ray.direction = vector_to_light(lights + l, ray.origin);
            ray.exclude = hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i];
            ray.instance = hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i];
            sum += brought * transmittance(&bvh, primitives, materials, &ray, shadow_t_max(lights + l));
        }
        store_soa3(contributions, 0u, capacity, i, sum);
    }
}
