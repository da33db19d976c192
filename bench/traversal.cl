// Closest hits are the engine's own kernels. Its shadow kernels compute light as well: here is what they do
// of traversal, on rays of a batch.

#include "kernels/intersect_packet.cl"
#include "kernels/intersect_scalar.cl"
#include "kernels/intersect_stream.cl"

kernel void occluded_scalar(const global BvhNode* nodes, const global uchar* leaves,
                            const global float* outlines, const global DeviceInstance* instances,
                            const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                            const global float* t_max, global uint* occlusion, const uint capacity,
                            const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        Ray ray = load_ray(rays, ray_ids, capacity, i);
        occlusion[i] = any_hit(&bvh, &ray, t_max[i]);
    }
}

/// Rays first.. of the batch as a list, as many as one holds.
static inline void gather_rays(ShadowRays* list, const global float* rays, const global uint* ray_ids,
                               const global float* t_max, uint capacity, uint first, uint count) {
    const uint end = SAHL_MIN(first + SAHL_SHADOW_RAYS, count);
    list->crossings = 0;
    list->count = 0;
    for (uint i = first; i < end; i += SAHL_LANES) {
        RayLanes lanes;
        lanes.origin = load_soa3v(rays, SAHL_RAY_ORIGIN, capacity, i);
        lanes.direction = load_soa3v(rays, SAHL_RAY_DIRECTION, capacity, i);
        lanes.primitive = load_idsv(ray_ids, SAHL_RAY_EXCLUDE, capacity, i) & SAHL_ID_MASK;
        lanes.instance = load_idsv(ray_ids, SAHL_RAY_INSTANCE, capacity, i);
        add_shadow_rays(list, &lanes, (1u << SAHL_MIN(end - i, SAHL_LANES)) - 1u, 0.0f);
    }
    for (uint k = 0; k < list->count; ++k) {
        list->t_max[k] = t_max[first + k];
    }
}

static inline void store_occlusions(const ShadowRays* list, global uint* occlusion, uint first) {
    for (uint k = 0; k < list->count; ++k) {
        occlusion[first + k] = list->occlusion[k];
    }
}

kernel void occluded_packet(const global BvhNode* nodes, const global uchar* leaves,
                            const global float* outlines, const global DeviceInstance* instances,
                            const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                            const global float* t_max, global uint* occlusion, const uint capacity,
                            const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent};
    const uint first = (uint)get_global_id(0) * SAHL_PACKET_RAYS;
    if (first < count) {
        const uint rays_here = SAHL_MIN(count - first, SAHL_PACKET_RAYS);
        Packet packet;
        load_packet(&packet, rays, ray_ids, capacity, first, count);
        for (uint k = 0; k < rays_here; ++k) {
            ((float*)&packet.hits[k / SAHL_GROUP_RAYS].t)[k % SAHL_GROUP_RAYS] = t_max[first + k];
        }
        trace_packet(&bvh, &packet, true);
        for (uint k = 0; k < rays_here; ++k) {
            occlusion[first + k] = strongest_occlusion(
                ((const uint*)&packet.hits[k / SAHL_GROUP_RAYS].occlusion)[k % SAHL_GROUP_RAYS]);
        }
    }
}

kernel void occluded_stream(const global BvhNode* nodes, const global uchar* leaves,
                            const global float* outlines, const global DeviceInstance* instances,
                            const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                            const global float* t_max, global uint* occlusion, const uint capacity,
                            const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent};
    const uint first = (uint)get_global_id(0) * SAHL_SHADOW_RAYS;
    if (first < count) {
        ShadowRays list;
        gather_rays(&list, rays, ray_ids, t_max, capacity, first, count);
        occlude_by_stream(&bvh, &list);
        store_occlusions(&list, occlusion, first);
    }
}
