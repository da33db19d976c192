// Rays -> closest hits, ray by ray.

#include "kernels/ray_batch.h"
#include "kernels/traverse_scalar.h"

kernel void intersect_scalar(const global BvhNode* nodes, const global uchar* leaves,
                             const global float* outlines, const global DeviceInstance* instances,
                             const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                             global float* hits, global uint* hit_ids, const uint capacity,
                             const uint count SAHL_COUNTS_PARAMETER) {
    SAHL_FOR_EACH_RAY(i, count) {
        const Bvh bvh = {nodes, leaves, outlines, instances, scene.extent SAHL_COUNTS_AT(i)};
        Ray ray = load_ray(rays, ray_ids, capacity, i);
        HitState hit = closest_hit(&bvh, &ray, hit_state(0.0f, INFINITY));
        store_hit(hits, hit_ids, capacity, i, &hit);
    }
}
