// Shadow rays -> the light that arrives, added to their hits' contributions in the order of the lights; lamp
// by lamp, by streams of single rays.

#include "kernels/shadow_work.h"
#include "kernels/traverse_stream.h"

kernel void shadow_stream(const global BvhNode* nodes, const global uchar* leaves,
                          const global float* outlines, const global DeviceInstance* instances,
                          const global DevicePrimitive* primitives, const global DeviceMaterial* materials,
                          const global DeviceLight* lights, const SceneConstants scene,
                          const global uint* hit_ids, const global float* shadow_surfaces,
                          const global float* shadow_light, const global uint* outcomes,
                          global float* contributions, const uint capacity,
                          const uint count SAHL_COUNTS_PARAMETER) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent SAHL_COUNTS_AT(get_global_id(0))};
    const ShadowWork work = {primitives,   materials, lights,        hit_ids, shadow_surfaces,
                             shadow_light, outcomes,  contributions, capacity};
    const uint first = (uint)get_global_id(0) * SAHL_SHADOW_RAYS;
    if (first < count) {
        ShadowRays list;
        list.crossings = 0;
        uint hits[SAHL_SHADOW_RAYS];
        for (uint l = 0; l < scene.light_count; ++l) {
            gather_shadow_rays(&work, l, first, SAHL_MIN(first + SAHL_SHADOW_RAYS, count), &list, hits);
            occlude_by_stream(&bvh, &list);
            add_light_of_list(&bvh, &work, l, &list, hits);
        }
    }
}
