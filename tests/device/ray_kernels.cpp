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

kernel void occlusion_scalar(const global BvhNode* nodes, const global uchar* leaves, const global float* outlines,
                             const global DeviceInstance* instances, const float extent, const global float* rays,
                             const global uint* ray_ids, const global float* t_max, global uint* out,
                             const uint capacity, const uint count) {
    const Bvh bvh = {nodes, leaves, outlines, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, capacity, i);
        out[i] = any_hit(&bvh, &ray, t_max[i]);
    }
}

static inline void load_list(ShadowRays* list, const global float* rays, const global uint* ray_ids,
                             const global float* t_max, uint capacity, uint first, uint count) {
    list->crossings = 0;
    list->count = min(count - first, SAHL_SHADOW_RAYS);
    for (uint k = 0; k < list->count; ++k) {
        const Ray ray = load_ray(rays, ray_ids, capacity, first + k);
        for (uint axis = 0; axis < 3u; ++axis) {
            list->origin[axis][k] = ((const float*)&ray.origin)[axis];
            list->direction[axis][k] = ((const float*)&ray.direction)[axis];
        }
        list->t_max[k] = t_max[first + k];
        list->start_primitive[k] = ray.exclude;
        list->start_instance[k] = ray.instance;
    }
}

#define OCCLUSION_BY(way, occlude)                                                                              \
    kernel void occlusion_##way(const global BvhNode* nodes, const global uchar* leaves,                        \
                                const global float* outlines, const global DeviceInstance* instances,           \
                                const float extent, const global float* rays, const global uint* ray_ids,       \
                                const global float* t_max, global uint* out, const uint capacity,               \
                                const uint count) {                                                             \
        const Bvh bvh = {nodes, leaves, outlines, instances, extent};                                           \
        const uint first = (uint)get_global_id(0) * SAHL_SHADOW_RAYS;                                           \
        if (first < count) {                                                                                    \
            ShadowRays list;                                                                                    \
            load_list(&list, rays, ray_ids, t_max, capacity, first, count);                                     \
            occlude(&bvh, &list);                                                                               \
            for (uint k = 0; k < list.count; ++k) { out[first + k] = list.occlusion[k]; }                       \
        }                                                                                                       \
    }
OCCLUSION_BY(packet, occlude_by_packets)
OCCLUSION_BY(stream, occlude_by_stream)

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

// Of each lane of v, what a float holds and what that lacks, at `at` of its `width` numbers in `out`.
static inline void store_parts(realv3 v, global float* out, uint i, uint width, uint at, uint count) {
    const floatv3 rounded = roundv(v), low = roundv(sub(v, widen(rounded)));
    for (uint k = 0; k < SAHL_LANES && i + k < count; ++k) {
        global float* to = out + width * (i + k) + at;
        vstore3((float3)(((const float*)&rounded.x)[k], ((const float*)&rounded.y)[k], ((const float*)&rounded.z)[k]), 0, to);
        vstore3((float3)(((const float*)&low.x)[k], ((const float*)&low.y)[k], ((const float*)&low.z)[k]), 1, to);
    }
}

kernel void surfaces(const global DevicePrimitive* primitives, const global float* shape_data,
                     const global DeviceInstance* instances, const global float* rays, const global float* hits,
                     const global uint* hit_ids, global float* out, const uint capacity, const uint count) {
    const Shapes shapes = {primitives, shape_data, instances};
    TEST_FOR_EACH_GROUP(i, count) {
        const uintv primitive = load_idsv(hit_ids, SAHL_HIT_PRIMITIVE, capacity, i);
        const intv hit = (lane_numbers() < (intv)((int)(count - i))) & (primitive != SAHL_NO_PRIMITIVE);
        if (lane_bits(hit) == 0u) { continue; }
        const floatv3 place = load_soa3v(hits, SAHL_HIT_T, capacity, i);
        const realv3 o = widen(load_soa3v(rays, SAHL_RAY_ORIGIN, capacity, i));
        const realv3 d = widen(load_soa3v(rays, SAHL_RAY_DIRECTION, capacity, i));
        const Surfaces s = surfaces_at(&shapes, hit, load_idsv(hit_ids, SAHL_HIT_INSTANCE, capacity, i),
                                       borrowed(hit, primitive), &o, &d, &place);
        store_parts(s.position, out, i, 19u, 0u, count);
        store_parts(s.ng, out, i, 19u, 6u, count);
        store_parts(s.ns, out, i, 19u, 12u, count);
        for (uint k = 0; k < SAHL_LANES && i + k < count; ++k) {
            out[19u * (i + k) + 18u] = ((const float*)&s.offset)[k];
        }
    }
}
)";

}  // namespace sahl::tests
