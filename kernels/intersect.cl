// Rays -> closest hits: one kernel for each way of traversal, of which the host takes the one that suits the
// device and the rays. Their hits are the same, bit for bit.

#include "kernels/traverse_packet.h"
#include "kernels/traverse_scalar.h"
#include "kernels/traverse_stream.h"

kernel void intersect_scalar(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* polygon_vertices, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        Ray ray = load_ray(rays, ray_ids, capacity, i);
        HitState hit = closest_hit(&bvh, &ray, hit_state(0.0f, INFINITY));
        store_hit(hits, hit_ids, capacity, i, &hit);
    }
}

kernel void intersect_packet(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* polygon_vertices, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    const uint first = (uint)get_global_id(0) * SAHL_PACKET_RAYS;
    if (first < count) {
        Packet packet;
        load_packet(&packet, rays, ray_ids, capacity, first, count);
        intersect_packet_of_rays(&bvh, &packet);
        store_packet(&packet, hits, hit_ids, capacity, first, count);
    }
}

kernel void intersect_stream(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* polygon_vertices, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    const uint first = (uint)get_global_id(0) * SAHL_STREAM_RAYS;
    if (first < count) {
        const RaySource source = {rays, ray_ids, hits, hit_ids, capacity, 0};
        intersect_by_stream(&bvh, &source, first, SAHL_MIN(first + SAHL_STREAM_RAYS, count));
    }
}
