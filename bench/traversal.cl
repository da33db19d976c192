// Closest hits are the engine's own kernels. Its shadow kernels compute light as well: here is what they do
// of traversal, one ray from a batch each.

#include "kernels/intersect.cl"
#include "kernels/ray_batch.h"
#include "kernels/traverse_scalar.h"

kernel void occluded_scalar(const global BvhNode* nodes, const global uchar* leaves,
                            const global float* polygon_vertices, const global DeviceInstance* instances,
                            const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                            const global float* t_max, global uint* occlusion, const uint capacity,
                            const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, scene.extent};
    SAHL_FOR_EACH_RAY(i, count) {
        Ray ray = load_ray(rays, ray_ids, capacity, i);
        occlusion[i] = any_hit(&bvh, &ray, t_max[i]);
    }
}
