// Packets of 128 rays in groups of sixteen: loading and storing them, and their passes: the rays of one
// octant and shear axis (triangle.h), for which near and far planes and the order of children are the same.
// What is done once a packet or pass is not inlined: compilers are done sooner, and loops keep registers.
#ifndef SAHL_PACKET_H
#define SAHL_PACKET_H

#include "kernels/ray_batch.h"
#include "kernels/ray_group.h"
#include "kernels/rays_per_item.h"
#include "kernels/shadow_rays.h"
#include "kernels/triangle_group.h"

#define SAHL_PACKET_GROUPS 8u

/// The rays of a packet, in the world and in the instance that is being walked through.
typedef struct {
    RayGroup rays[SAHL_LEVELS][SAHL_PACKET_GROUPS];
    GroupHits hits[SAHL_PACKET_GROUPS];
} Packet;

/// A pass: the packet's rays of one octant and shear axis.
typedef struct {
    PassAxes axes;
    float inverse_lo[3], inverse_hi[3];   // intervals over the rays
    float near_origin[3], far_origin[3];  // the origins that make near planes nearest, far ones farthest
    float margin[3];                      // by which boxes grow for the tests of sixteen rays
    float farthest;                       // of the groups' ranges
} Pass;

/// The pass that each ray of a group belongs to: octant + 8 · shear axis.
static inline int16 pass_of(const RayGroup* rays) {
    float16 x = fabs(rays->direction[0]), y = fabs(rays->direction[1]), z = fabs(rays->direction[2]);
    Lanes16 along_x = less_equal16(y, x) & less_equal16(z, x);
    Lanes16 along_y = less_equal16(z, y);
    int16 axis = select16(along_x, (int16)(0), select16(along_y, (int16)(8), (int16)(16)));
    return axis | (as_int16(rays->inverse[0]) >> 31 & (int16)(1)) |
           (as_int16(rays->inverse[1]) >> 31 & (int16)(2)) | (as_int16(rays->inverse[2]) >> 31 & (int16)(4));
}

/// One bit for each pass that the groups' rays need.
SAHL_NOINLINE uint passes_of(const RayGroup* rays, const GroupHits* hits, uint groups, int16* pass_numbers) {
    int16 passes = 0;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
        pass_numbers[g] = -1;
        if (groups >> g & 1u) {
            Lanes16 alive = are_traceable(rays + g) & less16((float16)(-INFINITY), hits[g].t);
            pass_numbers[g] = select16(alive, pass_of(rays + g), (int16)(-1));
            passes |= select16(alive, (int16)(1) << pass_of(rays + g), (int16)(0));
        }
    }
    int8 half_of_it = passes.lo | passes.hi;
    int4 quarter = half_of_it.lo | half_of_it.hi;
    return (uint)(quarter.x | quarter.y | quarter.z | quarter.w);
}

/// Sets up the rays of pass `number`: `far` where their ranges end (-inf for others), `group_far` the
/// farthest of each group. Returns the groups that have any.
SAHL_NOINLINE uint begin_pass(Pass* pass, uint number, uint instance, float extent, RayGroup* rays,
                              const GroupHits* hits, uint groups, const int16* pass_numbers, float16* far,
                              float16* cull_far, float* group_far) {
    const float16 infinite = INFINITY;
    PassAxes* axes = &pass->axes;
    axes->octant = number & 7u;
    axes->kz = number >> 3;
    axes->kx = axes->kz == 2u ? 0u : axes->kz + 1u;
    axes->ky = axes->kx == 2u ? 0u : axes->kx + 1u;
    axes->instance = instance;
    float16 inverse_lo[3], inverse_hi[3], origin_lo[3], origin_hi[3];
    for (uint k = 0; k < 3u; ++k) {
        inverse_lo[k] = infinite;
        inverse_hi[k] = -infinite;
        origin_lo[k] = infinite;
        origin_hi[k] = -infinite;
    }
    uint present = 0;
    pass->farthest = -INFINITY;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
        far[g] = -infinite;
        cull_far[g] = -infinite;
        group_far[g] = -INFINITY;
        if (!(groups >> g & 1u)) {
            continue;
        }
        RayGroup* group = rays + g;
        Lanes16 active = equal16(pass_numbers[g], (int16)((int)number));
        if (!any16(active)) {
            continue;
        }
        present |= 1u << g;
        far[g] = select16(active, hits[g].t, -infinite);
        cull_far[g] = far[g] * SAHL_CULL_SLACK;
        group_far[g] = greatest16(cull_far[g]);
        pass->farthest = SAHL_MAX(pass->farthest, group_far[g]);
        for (uint k = 0; k < 3u; ++k) {
            float16 low = select16(active, group->inverse[k], infinite);
            float16 high = select16(active, group->inverse[k], -infinite);
            inverse_lo[k] = SAHL_MIN(inverse_lo[k], low);
            inverse_hi[k] = SAHL_MAX(inverse_hi[k], high);
            low = select16(active, group->origin[k], infinite);
            high = select16(active, group->origin[k], -infinite);
            origin_lo[k] = SAHL_MIN(origin_lo[k], low);
            origin_hi[k] = SAHL_MAX(origin_hi[k], high);
        }
        float16 dz = group->direction[axes->kz];
        group->shear_x = -(group->direction[axes->kx] / dz);
        group->shear_y = -(group->direction[axes->ky] / dz);
    }
    axes->common_origin = true;
    for (uint k = 0; k < 3u; ++k) {
        pass->inverse_lo[k] = least16(inverse_lo[k]);
        pass->inverse_hi[k] = greatest16(inverse_hi[k]);
        float lo = least16(origin_lo[k]), hi = greatest16(origin_hi[k]);
        // Outward by what covers the rounding here and of the primitives' tests (see bvh.h). A box that has
        // grown by twice that is entered before, and left behind, where RayBoxTest has it.
        const float e = (SAHL_MAX(fabs(lo), fabs(hi)) + extent) * 0x1p-20f;
        pass->margin[k] = 2.0f * e;
        bool backward = (axes->octant >> k & 1u) != 0u;
        pass->near_origin[k] = backward ? lo - e : hi + e;
        pass->far_origin[k] = backward ? hi + e : lo - e;
        axes->common_origin = axes->common_origin && lo == hi;
        axes->origin[k] = lo;
    }
    return present;
}

/// A group without rays: none of its lanes is traced.
static inline void clear_group(RayGroup* rays, GroupHits* hits) {
    for (uint k = 0; k < 3u; ++k) {
        rays->origin[k] = (float16)(0.0f);
        rays->direction[k] = (float16)(0.0f);
    }
    hits->t = (float16)(-INFINITY);
    hits->start_primitive = (int16)((int)SAHL_NO_PRIMITIVE);
    hits->start_instance = (int16)((int)SAHL_WORLD);
}

static inline void clear_hits(GroupHits* hits) {
    hits->u = (float16)(0.0f);
    hits->v = (float16)(0.0f);
    hits->primitive = (int16)(-1);
    hits->instance = (int16)(-1);
    hits->occlusion = (int16)((int)SAHL_HIT_NOTHING);
}

/// Rays first.. of a batch, up to `end`.
SAHL_NOINLINE void load_packet(Packet* packet, const global float* rays, const global uint* ray_ids,
                               uint capacity, uint first, uint end) {
    const global uint* starts = ray_ids + (size_t)SAHL_RAY_EXCLUDE * capacity;
    const global uint* instances = ray_ids + (size_t)SAHL_RAY_INSTANCE * capacity;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g, first += 16u) {
        RayGroup* group = packet->rays[0] + g;
        GroupHits* hits = packet->hits + g;
        clear_hits(hits);
        if (first + 16u <= end) {
            for (uint k = 0; k < 3u; ++k) {
                group->origin[k] = vload16(0, rays + (size_t)(SAHL_RAY_ORIGIN + k) * capacity + first);
                group->direction[k] = vload16(0, rays + (size_t)(SAHL_RAY_DIRECTION + k) * capacity + first);
            }
            hits->t = (float16)(INFINITY);
            hits->start_primitive = as_int16(vload16(0, starts + first) & SAHL_ID_MASK);
            hits->start_instance = as_int16(vload16(0, instances + first));
            continue;
        }
        clear_group(group, hits);
        for (uint lane = 0; first + lane < end; ++lane) {
            const Ray ray = load_ray(rays, ray_ids, capacity, first + lane);
            set_lane(group, hits, lane, &ray, INFINITY);
        }
    }
}

/// Rays first.. of a list.
SAHL_NOINLINE void load_shadow_packet(Packet* packet, const ShadowRays* list, uint first) {
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g, first += 16u) {
        RayGroup* group = packet->rays[0] + g;
        GroupHits* hits = packet->hits + g;
        clear_hits(hits);
        if (first + 16u <= list->count) {
            for (uint k = 0; k < 3u; ++k) {
                group->origin[k] = vload16(0, list->origin[k] + first);
                group->direction[k] = vload16(0, list->direction[k] + first);
            }
            hits->t = vload16(0, list->t_max + first);
            hits->start_primitive = as_int16(vload16(0, list->start_primitive + first));
            hits->start_instance = as_int16(vload16(0, list->start_instance + first));
            continue;
        }
        clear_group(group, hits);
        for (uint lane = 0; first + lane < list->count; ++lane) {
            const Ray ray = shadow_ray(list, first + lane);
            set_lane(group, hits, lane, &ray, list->t_max[first + lane]);
        }
    }
}

/// Hits of the rays first.. of a batch, up to `end`.
SAHL_NOINLINE void store_packet(const Packet* packet, global float* hits, global uint* hit_ids, uint capacity,
                                uint first, uint end) {
    for (uint g = 0; g < SAHL_PACKET_GROUPS && first < end; ++g, first += 16u) {
        const GroupHits* group = packet->hits + g;
        const Lanes16 none = less16(group->primitive, (int16)(0));
        const int16 primitive = select16(none, (int16)((int)SAHL_NO_PRIMITIVE), group->primitive);
        const int16 instance = select16(none, (int16)((int)SAHL_WORLD), group->instance);
        global uint* primitives = hit_ids + (size_t)SAHL_HIT_PRIMITIVE * capacity + first;
        global uint* instances = hit_ids + (size_t)SAHL_HIT_INSTANCE * capacity + first;
        if (first + 16u <= end) {
            vstore16(group->t, 0, hits + (size_t)SAHL_HIT_T * capacity + first);
            vstore16(group->u, 0, hits + (size_t)SAHL_HIT_U * capacity + first);
            vstore16(group->v, 0, hits + (size_t)SAHL_HIT_V * capacity + first);
            vstore16(as_uint16(primitive), 0, primitives);
            vstore16(as_uint16(instance), 0, instances);
            continue;
        }
        for (uint lane = 0; first + lane < end; ++lane) {
            store_soa3(hits, SAHL_HIT_T, capacity, first + lane,
                       (float3)(lane_of(group->t, lane), lane_of(group->u, lane), lane_of(group->v, lane)));
            primitives[lane] = ((const uint*)&primitive)[lane];
            instances[lane] = ((const uint*)&instance)[lane];
        }
    }
}

static inline void store_occlusion(const Packet* packet, ShadowRays* list, uint first) {
    for (uint g = 0; g < SAHL_PACKET_GROUPS && first < list->count; ++g, first += 16u) {
        const int16 occlusion = packet->hits[g].occlusion, opaque = occlusion & (int16)((int)SAHL_HIT_OPAQUE);
        const int16 strongest = select16(equal16(opaque, (int16)(0)), occlusion, opaque);
        vstore16(as_uint16(strongest), 0, list->occlusion + first);
    }
}

#endif
