// Rays -> closest hits, by streams of single rays.

#include "kernels/traverse_stream.h"

kernel void intersect_stream(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* outlines, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count SAHL_COUNTS_PARAMETER) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent SAHL_COUNTS_AT(get_global_id(0))};
    const uint first = (uint)get_global_id(0) * SAHL_STREAM_RAYS;
    if (first < count) {
        const RaySource source = {rays, ray_ids, hits, hit_ids, capacity, 0};
        intersect_by_stream(&bvh, &source, first, SAHL_MIN(first + SAHL_STREAM_RAYS, count));
    }
}
