#include "tests/device/ray_kernels.h"

namespace sahl::tests {

const char* const ray_kernels = R"(
#include "kernels/intersect_scalar.cl"
#include "kernels/intersect_packet.cl"
#include "kernels/intersect_stream.cl"
#include "kernels/shade.cl"
#include "kernels/shadow_scalar.cl"
#include "kernels/shadow_packet.cl"
#include "kernels/shadow_stream.cl"

kernel void brute_force(const global uchar* leaves, const global float* outlines,
                        const global DeviceInstance* instances, const global uint* children,
                        const global uint* child_instances, const uint child_count, const float extent,
                        const global float* rays, const global uint* ray_ids,
                        global float* hits, global uint* hit_ids, const uint count) {
    const Bvh bvh = {0, leaves, outlines, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        HitState state = hit_state(0.0f, INFINITY);
        TracedRay here = traced_ray(ray.origin, ray.direction, &ray, SAHL_WORLD, extent);
        for (uint k = 0; k < child_count; ++k) {
            if (child_instances[k] != state.inside_of) {
                state.inside_of = child_instances[k];
                here = traced_in_instance(&bvh, &ray, state.inside_of - 1u);
            }
            intersect_leaf(&bvh, children[k], &here.ray, &here.shear, &here.boxes, &state, false);
        }
        store_hit(hits, hit_ids, count, i, &state);
    }
}

kernel void occlusion(const global BvhNode* nodes, const global uchar* leaves, const global float* outlines,
                      const global DeviceInstance* instances, const float extent, const global float* rays, const global uint* ray_ids, const float t_max,
                      global uint* out, const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        out[i] = any_hit(&bvh, &ray, t_max);
    }
}

kernel void walk(const global BvhNode* nodes, const global uchar* leaves, const global float* outlines,
                 const global DeviceInstance* instances, const float extent, const global float* rays, const global uint* ray_ids, const float t_max,
                 const uint longest, global uint* out, const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        global uint* crossings = out + (size_t)i * (1u + 3u * longest);
        uint met = 0;
        HitState range = hit_state(0.0f, t_max);
        Crossings found;
        do {
            collect_crossings(&bvh, &ray, range, &found);
            for (uint k = 0; k < found.count && met < longest; ++k, ++met) {
                crossings[1u + met] = (uint)found.rank[k];
                crossings[1u + longest + met] = (uint)(found.rank[k] >> 32);
                crossings[1u + 2u * longest + met] = as_uint(found.t[k]);
                range.t_min = found.t[k];
                range.min_rank = found.rank[k];
            }
        } while (found.count == SAHL_MOST_CROSSINGS && met < longest);
        crossings[0] = met;
    }
}

static inline void store_parts(global float* to, real3 v) {
    float3 rounded = round3(v);
    vstore3(rounded, 0, to);
    vstore3(round3(v - convert_real3(rounded)), 1, to);
}

kernel void surfaces(const global DevicePrimitive* primitives, const global float* shape_data,
                     const global DeviceInstance* instances, const global float* rays, const global float* hits,
                     const global uint* hit_ids, global float* out, const uint count) {
    const Shapes shapes = {primitives, shape_data, instances};
    TEST_FOR_EACH(i, count) {
        if (hit_ids[i] == SAHL_NO_PRIMITIVE) { continue; }
        float3 hit = load_soa3(hits, SAHL_HIT_T, count, i);
        real3 o = convert_real3(load_soa3(rays, SAHL_RAY_ORIGIN, count, i));
        real3 d = convert_real3(load_soa3(rays, SAHL_RAY_DIRECTION, count, i));
        Surface s = surface_at(&shapes, hit_ids[count + i], hit_ids[i], o, d, hit.x, hit.y, hit.z);
        store_parts(out + 19 * i, s.position);
        store_parts(out + 19 * i + 6, s.ng);
        store_parts(out + 19 * i + 12, s.ns);
        out[19 * i + 18] = s.offset;
    }
}
)";

}  // namespace sahl::tests
