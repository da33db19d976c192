// Shadow rays -> the light that arrives, added to their hits' contributions in the order of the lights; ray
// by ray.

#include "kernels/shadow_work.h"

kernel void shadow_scalar(const global BvhNode* nodes, const global uchar* leaves,
                          const global float* outlines, const global DeviceInstance* instances,
                          const global DevicePrimitive* primitives, const global DeviceMaterial* materials,
                          const global DeviceLight* lights, const SceneConstants scene,
                          const global uint* hit_ids, const global float* shadow_surfaces,
                          const global float* shadow_light, const global uint* outcomes,
                          global float* contributions, const uint capacity,
                          const uint count SAHL_COUNTS_PARAMETER) {
    const ShadowWork work = {primitives,   materials, lights,        hit_ids, shadow_surfaces,
                             shadow_light, outcomes,  contributions, capacity};
    SAHL_FOR_EACH_GROUP(i, count) {
        for (uint l = 0; l < scene.light_count; ++l) {
            const float t_max = shadow_t_max(lights + l);
            uint lanes = lanes_to_light(&work, l, i, count);
            if (lanes == 0u) {
                continue;
            }
            const RayLanes rays = rays_to_light(&work, l, i);
            for (; lanes != 0u; lanes &= lanes - 1u) {
                const Ray ray = ray_of_lane(&rays, lowest_lane(lanes));
                const uint k = i + lowest_lane(lanes);
                const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent SAHL_COUNTS_AT(k)};
                add_light(&work, k,
                          brought_light(&work, l, k) *
                              transmittance(&bvh, &work, &ray, t_max, any_hit(&bvh, &ray, t_max), 0));
            }
        }
    }
}
