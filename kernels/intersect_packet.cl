// Rays -> closest hits, by packets of neighbours.

#include "kernels/traverse_packet.h"

kernel void intersect_packet(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* outlines, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count SAHL_COUNTS_PARAMETER) {
    const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent SAHL_COUNTS_AT(get_global_id(0))};
    const uint first = (uint)get_global_id(0) * SAHL_PACKET_RAYS;
    if (first < count) {
        Packet packet;
        load_packet(&packet, rays, ray_ids, capacity, first, count);
        intersect_packet_of_rays(&bvh, &packet);
        store_packet(&packet, hits, hit_ids, capacity, first, count);
    }
}
