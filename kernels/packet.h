// Packets of 128 rays in groups (simd.h): loading and storing them, and their passes: the rays of one
// octant and shear axis (triangle.h), for which near and far planes and the order of children are the same.
// What is done once a packet or pass is not inlined: compilers are done sooner, and loops keep registers.
#ifndef SAHL_PACKET_H
#define SAHL_PACKET_H

#include "kernels/ray_batch.h"
#include "kernels/ray_group.h"
#include "kernels/rays_per_item.h"
#include "kernels/shadow_rays.h"
#include "kernels/triangle_group.h"

#define SAHL_PACKET_GROUPS (SAHL_PACKET_RAYS / SAHL_GROUP_RAYS)

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
    float margin[3];                      // by which boxes grow for the tests of groups
    float farthest;                       // of the groups' ranges
} Pass;

/// The pass that each ray of a group belongs to: octant + 8 · shear axis.
static inline intg pass_of(const RayGroup* rays) {
    floatg x = fabs(rays->direction[0]), y = fabs(rays->direction[1]), z = fabs(rays->direction[2]);
    LaneMask along_x = less_equalg(y, x) & less_equalg(z, x);
    LaneMask along_y = less_equalg(z, y);
    intg axis = selectg(along_x, (intg)(0), selectg(along_y, (intg)(8), (intg)(16)));
    return axis | (as_intg(rays->inverse[0]) >> 31 & (intg)(1)) |
           (as_intg(rays->inverse[1]) >> 31 & (intg)(2)) | (as_intg(rays->inverse[2]) >> 31 & (intg)(4));
}

/// One bit for each pass that the groups' rays need.
SAHL_NOINLINE uint passes_of(const RayGroup* rays, const GroupHits* hits, uint groups, intg* pass_numbers) {
    intg passes = 0;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
        pass_numbers[g] = -1;
        if (groups >> g & 1u) {
            LaneMask alive = lessg(are_traceable(rays[g].origin, rays[g].direction), (intg)(0)) &
                             lessg((floatg)(-INFINITY), hits[g].t);
            pass_numbers[g] = selectg(alive, pass_of(rays + g), (intg)(-1));
            passes |= selectg(alive, (intg)(1) << pass_of(rays + g), (intg)(0));
        }
    }
    uint of_all = 0;
    for (uint lane = 0; lane < SAHL_GROUP_RAYS; ++lane) {
        of_all |= ((const uint*)&passes)[lane];
    }
    return of_all;
}

/// Sets up the rays of pass `number`: `far` where their ranges end (-inf for others), `group_far` the
/// farthest of each group. Returns the groups that have any.
SAHL_NOINLINE uint begin_pass(Pass* pass, uint number, uint instance, float extent, RayGroup* rays,
                              const GroupHits* hits, uint groups, const intg* pass_numbers, floatg* far,
                              floatg* cull_far, float* group_far) {
    const floatg infinite = INFINITY;
    PassAxes* axes = &pass->axes;
    axes->octant = number & 7u;
    axes->kz = number >> 3;
    axes->kx = axes->kz == 2u ? 0u : axes->kz + 1u;
    axes->ky = axes->kx == 2u ? 0u : axes->kx + 1u;
    axes->instance = instance;
    floatg inverse_lo[3], inverse_hi[3], origin_lo[3], origin_hi[3];
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
        LaneMask active = equalg(pass_numbers[g], (intg)((int)number));
        if (!anyg(active)) {
            continue;
        }
        present |= 1u << g;
        far[g] = selectg(active, hits[g].t, -infinite);
        cull_far[g] = far[g] * SAHL_CULL_SLACK;
        group_far[g] = greatestg(cull_far[g]);
        pass->farthest = SAHL_MAX(pass->farthest, group_far[g]);
        for (uint k = 0; k < 3u; ++k) {
            floatg low = selectg(active, group->inverse[k], infinite);
            floatg high = selectg(active, group->inverse[k], -infinite);
            inverse_lo[k] = SAHL_MIN(inverse_lo[k], low);
            inverse_hi[k] = SAHL_MAX(inverse_hi[k], high);
            low = selectg(active, group->origin[k], infinite);
            high = selectg(active, group->origin[k], -infinite);
            origin_lo[k] = SAHL_MIN(origin_lo[k], low);
            origin_hi[k] = SAHL_MAX(origin_hi[k], high);
        }
        floatg dz = group->direction[axes->kz];
        group->shear_x = -(group->direction[axes->kx] / dz);
        group->shear_y = -(group->direction[axes->ky] / dz);
    }
    axes->common_origin = true;
    for (uint k = 0; k < 3u; ++k) {
        pass->inverse_lo[k] = leastg(inverse_lo[k]);
        pass->inverse_hi[k] = greatestg(inverse_hi[k]);
        float lo = leastg(origin_lo[k]), hi = greatestg(origin_hi[k]);
        // Outward by what covers the rounding of the primitives' tests (see bvh.h), and as much again for the
        // rounding here: a box is entered before, and left behind, where RayBoxTest has it, where distances
        // that a grazing ray has badly defined are kept to (keep_to_box()).
        const float margin = (SAHL_MAX(fabs(lo), fabs(hi)) + extent) * 0x1p-19f;
        pass->margin[k] = margin;
        bool backward = (axes->octant >> k & 1u) != 0u;
        pass->near_origin[k] = backward ? lo - margin : hi + margin;
        pass->far_origin[k] = backward ? hi + margin : lo - margin;
        axes->common_origin = axes->common_origin && lo == hi;
        axes->origin[k] = lo;
    }
    return present;
}

/// A group without rays: none of its lanes is traced.
static inline void clear_group(RayGroup* rays, GroupHits* hits) {
    for (uint k = 0; k < 3u; ++k) {
        rays->origin[k] = (floatg)(0.0f);
        rays->direction[k] = (floatg)(0.0f);
    }
    hits->t = (floatg)(-INFINITY);
    hits->start_primitive = (intg)((int)SAHL_NO_PRIMITIVE);
    hits->start_instance = (intg)((int)SAHL_WORLD);
}

static inline void clear_hits(GroupHits* hits) {
    hits->u = (floatg)(0.0f);
    hits->v = (floatg)(0.0f);
    hits->primitive = (intg)(-1);
    hits->instance = (intg)(-1);
    hits->occlusion = (intg)((int)SAHL_HIT_NOTHING);
    hits->crossings = 0;
}

/// Rays first.. of a batch, up to `end`.
SAHL_NOINLINE void load_packet(Packet* packet, const global float* rays, const global uint* ray_ids,
                               uint capacity, uint first, uint end) {
    const global uint* starts = ray_ids + (size_t)SAHL_RAY_EXCLUDE * capacity;
    const global uint* instances = ray_ids + (size_t)SAHL_RAY_INSTANCE * capacity;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g, first += SAHL_GROUP_RAYS) {
        RayGroup* group = packet->rays[0] + g;
        GroupHits* hits = packet->hits + g;
        clear_hits(hits);
        if (first + SAHL_GROUP_RAYS <= end) {
            for (uint k = 0; k < 3u; ++k) {
                group->origin[k] = vloadg(0, rays + (size_t)(SAHL_RAY_ORIGIN + k) * capacity + first);
                group->direction[k] = vloadg(0, rays + (size_t)(SAHL_RAY_DIRECTION + k) * capacity + first);
            }
            hits->t = (floatg)(INFINITY);
            hits->start_primitive = as_intg(vloadg(0, starts + first) & SAHL_ID_MASK);
            hits->start_instance = as_intg(vloadg(0, instances + first));
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
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g, first += SAHL_GROUP_RAYS) {
        RayGroup* group = packet->rays[0] + g;
        GroupHits* hits = packet->hits + g;
        clear_hits(hits);
        hits->crossings = list->crossings != 0 ? list->crossings + first : 0;
        if (first + SAHL_GROUP_RAYS <= list->count) {
            for (uint k = 0; k < 3u; ++k) {
                group->origin[k] = vloadg(0, list->origin[k] + first);
                group->direction[k] = vloadg(0, list->direction[k] + first);
            }
            hits->t = vloadg(0, list->t_max + first);
            hits->start_primitive = as_intg(vloadg(0, list->start_primitive + first));
            hits->start_instance = as_intg(vloadg(0, list->start_instance + first));
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
    for (uint g = 0; g < SAHL_PACKET_GROUPS && first < end; ++g, first += SAHL_GROUP_RAYS) {
        const GroupHits* group = packet->hits + g;
        const LaneMask none = lessg(group->primitive, (intg)(0));
        const intg primitive = selectg(none, (intg)((int)SAHL_NO_PRIMITIVE), group->primitive);
        const intg instance = selectg(none, (intg)((int)SAHL_WORLD), group->instance);
        global uint* primitives = hit_ids + (size_t)SAHL_HIT_PRIMITIVE * capacity + first;
        global uint* instances = hit_ids + (size_t)SAHL_HIT_INSTANCE * capacity + first;
        if (first + SAHL_GROUP_RAYS <= end) {
            vstoreg(group->t, 0, hits + (size_t)SAHL_HIT_T * capacity + first);
            vstoreg(group->u, 0, hits + (size_t)SAHL_HIT_U * capacity + first);
            vstoreg(group->v, 0, hits + (size_t)SAHL_HIT_V * capacity + first);
            vstoreg(as_uintg(primitive), 0, primitives);
            vstoreg(as_uintg(instance), 0, instances);
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
    for (uint g = 0; g < SAHL_PACKET_GROUPS && first < list->count; ++g, first += SAHL_GROUP_RAYS) {
        const intg occlusion = packet->hits[g].occlusion, opaque = occlusion & (intg)((int)SAHL_HIT_OPAQUE);
        const intg strongest = selectg(equalg(opaque, (intg)(0)), occlusion, opaque);
        vstoreg(as_uintg(strongest), 0, list->occlusion + first);
    }
}

#endif
