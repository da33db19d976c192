// Traversal of the 8-wide tree by packets of 128 rays, for rays that go much the same way: camera rays
// and shadow rays to a point.
//
// A packet is split into passes by octant and shear axis (triangle.h), so that within a pass near and
// far planes and the order of children are the same for all rays. At a node one test of the pass's
// interval of rays against eight boxes (Reshetov, Soupikov, Hurley 2005, "Multi-Level Ray Tracing
// Algorithm", sec. 3; Boulos, Wald, Shirley 2006, "Geometric and Arithmetic Culling Methods for Entire
// Ray Packets") drops most children; those left are prefetched and tested by groups of rays (simd.h). In
// a leaf one triangle or other shape at a time meets a group.
// Instances wait until their place in the tree has been passed; then the packet's rays are transformed
// and walk the group's tree by passes of their own.
// Pro: memory is read once for 128 rays, and all arithmetic is as wide as registers. Con: rays that part ways
// drag each other along; traverse_stream.h is for those.
#ifndef SAHL_TRAVERSE_PACKET_H
#define SAHL_TRAVERSE_PACKET_H

#include "kernels/packet.h"
#include "kernels/shape_group.h"
#include "kernels/traverse_scalar.h"
#include "kernels/triangle_group.h"

#define SAHL_WAITING_INSTANCES 32u

/// Along one axis: where the first ray may pass the near planes, or the last one the far planes.
static inline float8 first_crossing(float8 planes, float origin, float inverse_lo, float inverse_hi) {
    float8 distance = planes - origin;
    return SAHL_MIN(distance * inverse_lo, distance * inverse_hi);
}
static inline float8 last_crossing(float8 planes, float origin, float inverse_lo, float inverse_hi) {
    float8 distance = planes - origin;
    return SAHL_MAX(distance * inverse_lo, distance * inverse_hi);
}

/// The groups that have a ray which reaches `entry`. `group_far`: where the farthest of each ends.
static inline uint groups_that_reach(float entry, const float* group_far) {
#if SAHL_PACKET_GROUPS == 8
    return mask8_le((float8)(entry), vload8(0, group_far));
#else
    return mask16_le((float16)(entry), vload16(0, group_far));
#endif
}

/// The children that rays of the pass may meet; *entry: the nearest that any enters each.
static inline uint children_of_interest(const global BvhNode* node, const Pass* pass, float8* entry) {
    const global float* planes = (const global float*)node;
    const uint octant = pass->axes.octant;
    const float* lo = pass->inverse_lo;
    const float* hi = pass->inverse_hi;
    uint x = octant & 1u ? 3u : 0u, y = octant & 2u ? 4u : 1u, z = octant & 4u ? 5u : 2u;
    float8 enter = SAHL_MAX(
        SAHL_MAX(first_crossing(vload8(x, planes), pass->near_origin[0], lo[0], hi[0]),
                 first_crossing(vload8(y, planes), pass->near_origin[1], lo[1], hi[1])),
        SAHL_MAX(first_crossing(vload8(z, planes), pass->near_origin[2], lo[2], hi[2]), (float8)(0.0f)));
    float8 leave =
        SAHL_MIN(SAHL_MIN(last_crossing(vload8(3u - x, planes), pass->far_origin[0], lo[0], hi[0]),
                          last_crossing(vload8(5u - y, planes), pass->far_origin[1], lo[1], hi[1])),
                 SAHL_MIN(last_crossing(vload8(7u - z, planes), pass->far_origin[2], lo[2], hi[2]),
                          (float8)(pass->farthest)));
    *entry = enter;
    return mask8_le(enter, leave);
}

/// The groups of `groups` of which a ray meets child `slot`. Boxes grow by the pass's margin instead of
/// having each ray's own, as loading those would take as long as all the rest.
static inline uint groups_that_meet(const global BvhNode* node, uint slot, const Pass* pass,
                                    const RayGroup* rays, const floatg* cull_far, uint groups) {
    const global float* planes = (const global float*)node + slot;
    float near[3], far[3];
#pragma unroll
    for (uint k = 0; k < 3u; ++k) {
        const bool backward = (pass->axes.octant >> k & 1u) != 0u;
        const float lo = planes[8u * k] - pass->margin[k], hi = planes[24u + 8u * k] + pass->margin[k];
        const float origin = pass->axes.common_origin ? pass->axes.origin[k] : 0.0f;
        near[k] = (backward ? hi : lo) - origin;
        far[k] = (backward ? lo : hi) - origin;
    }
    uint met = 0;
    if (pass->axes.common_origin) {
        for (; groups != 0u; groups &= groups - 1u) {
            const uint g = lowest_lane(groups);
            const floatg* r = rays[g].inverse;
            floatg enter =
                SAHL_MAX(SAHL_MAX(near[0] * r[0], near[1] * r[1]), SAHL_MAX(near[2] * r[2], (floatg)(0.0f)));
            floatg leave =
                SAHL_MIN(SAHL_MIN(far[0] * r[0], far[1] * r[1]), SAHL_MIN(far[2] * r[2], cull_far[g]));
            met |= (uint)anyg(less_equalg(enter, leave)) << g;
        }
        return met;
    }
    for (; groups != 0u; groups &= groups - 1u) {
        const uint g = lowest_lane(groups);
        const floatg* r = rays[g].inverse;
        const floatg* c = rays[g].addend;
        floatg enter =
            SAHL_MAX(SAHL_MAX(fma((floatg)(near[0]), r[0], c[0]), fma((floatg)(near[1]), r[1], c[1])),
                     SAHL_MAX(fma((floatg)(near[2]), r[2], c[2]), (floatg)(0.0f)));
        floatg leave =
            SAHL_MIN(SAHL_MIN(fma((floatg)(far[0]), r[0], c[0]), fma((floatg)(far[1]), r[1], c[1])),
                     SAHL_MIN(fma((floatg)(far[2]), r[2], c[2]), cull_far[g]));
        met |= (uint)anyg(less_equalg(enter, leave)) << g;
    }
    return met;
}

/// A leaf's one block of any kind but triangles. Returns whether a range has changed.
SAHL_NOINLINE bool intersect_shapes_group(const Bvh* bvh, uint child, const GroupTest* test) {
    const global uchar* block = leaf_block(bvh, child);
    switch (child_kind(child)) {
        case SAHL_KIND_SPHERE:
            return intersect_spheres_group(test, (const global SphereBlock*)block);
        case SAHL_KIND_POLYGON:
            return intersect_polygon_group(test, (const global PolygonBlock*)block, bvh->outlines);
        default:
            return intersect_quadrics_group(test, (const global QuadricBlock*)block, child_kind(child));
    }
}

/// The rays of `groups` in the space of instance `i`'s group.
SAHL_NOINLINE void enter_instance(const Bvh* bvh, Packet* packet, uint groups, uint i) {
    const global DeviceInstance* instance = bvh->instances + i;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
        if (!(groups >> g & 1u)) {
            continue;
        }
        const RayGroup* from = packet->rays[0] + g;
        RayGroup* to = packet->rays[1] + g;
        for (uint lane = 0; lane < SAHL_GROUP_RAYS; ++lane) {
            float3 o = (float3)(lane_of(from->origin[0], lane), lane_of(from->origin[1], lane),
                                lane_of(from->origin[2], lane));
            float3 d = (float3)(lane_of(from->direction[0], lane), lane_of(from->direction[1], lane),
                                lane_of(from->direction[2], lane));
            o = round3(group_from_world_point(instance, convert_real3(o)));
            d = round3(group_from_world_vector(instance, convert_real3(d)));
            ((float*)&to->origin[0])[lane] = o.x;
            ((float*)&to->origin[1])[lane] = o.y;
            ((float*)&to->origin[2])[lane] = o.z;
            ((float*)&to->direction[0])[lane] = d.x;
            ((float*)&to->direction[1])[lane] = d.y;
            ((float*)&to->direction[2])[lane] = d.z;
        }
        prepare_box_tests(to, instance->extent);
        to->exclude = selectg(equalg(packet->hits[g].start_instance, (intg)((int)i + 1)),
                              packet->hits[g].start_primitive, (intg)((int)SAHL_NO_PRIMITIVE));
    }
}

/// Brings the packet's hits up to hits[g].t into `hits`: the first ones, or with any_hit what kinds of
/// surfaces there are.
SAHL_INLINE void trace_packet(const Bvh* bvh, Packet* packet, bool any_hit) {
    GroupHits* hits = packet->hits;
    uint stack[SAHL_LEVELS * SAHL_STACK_SIZE];
    float entries[SAHL_LEVELS * SAHL_STACK_SIZE];
    uint stack_groups[SAHL_LEVELS * SAHL_STACK_SIZE];
    uint waiting[SAHL_WAITING_INSTANCES], waiting_groups[SAHL_WAITING_INSTANCES];
    uint waiting_count = 0;
    // Where ranges end, and beyond which boxes are culled: for each ray, for each group.
    floatg far[SAHL_PACKET_GROUPS], cull_far[SAHL_PACKET_GROUPS];
    float group_far[SAHL_PACKET_GROUPS];
    intg pass_numbers[SAHL_LEVELS][SAHL_PACKET_GROUPS];

    uint level = 0, root = 0, instance = SAHL_WORLD, groups = (1u << SAHL_PACKET_GROUPS) - 1u;
    uint size = 0, base = 0;
    float extent = bvh->extent;
    for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
        prepare_box_tests(packet->rays[0] + g, extent);
        packet->rays[0][g].exclude = selectg(equalg(hits[g].start_instance, (intg)((int)SAHL_WORLD)),
                                             hits[g].start_primitive, (intg)((int)SAHL_NO_PRIMITIVE));
    }
    uint passes = passes_of(packet->rays[0], hits, groups, pass_numbers[0]);
    uint world_passes = 0;
    for (;;) {
        if (passes == 0u || waiting_count == SAHL_WAITING_INSTANCES) {
            // This tree is done, or no more instances can wait: on to one of those, or back to the world.
            if (level == 0u) {
                world_passes = passes;
                base = size;
            }
            if (waiting_count > 0u) {
                --waiting_count;
                uint i = waiting[waiting_count];
                level = 1u;
                instance = i + 1u;
                root = bvh->instances[i].root;
                extent = bvh->instances[i].extent;
                groups = waiting_groups[waiting_count];
                enter_instance(bvh, packet, groups, i);
                passes = passes_of(packet->rays[1], hits, groups, pass_numbers[1]);
                continue;
            }
            if (level == 0u || world_passes == 0u) {
                break;
            }
            level = 0u;
            root = 0u;
            instance = SAHL_WORLD;
            extent = bvh->extent;
            groups = (1u << SAHL_PACKET_GROUPS) - 1u;
            passes = world_passes;
            base = 0u;
        }
        RayGroup* rays = packet->rays[level];
        const uint number = lowest_lane(passes);
        Pass pass;
        uint present = begin_pass(&pass, number, instance, extent, rays, hits, groups, pass_numbers[level],
                                  far, cull_far, group_far);
        pass.axes.alone = (passes & (passes - 1u)) == 0u;
        const uint octant = pass.axes.octant;
        if (size == base) {
            stack[size] = root;
            entries[size] = 0.0f;
            stack_groups[size] = present;
            ++size;
        }
        while (size > base && waiting_count < SAHL_WAITING_INSTANCES) {
            --size;
            const uint child = stack[size];
            uint met = groups_that_reach(entries[size], group_far) & stack_groups[size];
            if (met == 0u) {
                continue;
            }
            if (!(child & SAHL_CHILD_LEAF)) {
                const global BvhNode* node = bvh->nodes + child;
                float8 entry;
                SAHL_COUNT_NODE(bvh, SAHL_INTERVAL_FLOP);
                uint order = permute_by_octant(children_of_interest(node, &pass, &entry), octant);
                while (order != 0u) {
                    uint position = highest_lane(order);
                    order ^= 1u << position;
                    uint slot = position ^ octant;
                    uint next = node->child[slot];
                    prefetch_child(bvh, next);
                    SAHL_COUNT(bvh, SAHL_COUNT_FLOP,
                               SAHL_GROUP_RAYS * popcount(met) *
                                   (pass.axes.common_origin ? SAHL_COMMON_BOX_FLOP : SAHL_BOX_FLOP));
                    uint meeting = groups_that_meet(node, slot, &pass, rays, cull_far, met);
                    stack[size] = next;
                    entries[size] = ((float*)&entry)[slot];
                    stack_groups[size] = meeting;
                    size += meeting != 0u;
                }
                continue;
            }
            if (child_kind(child) == SAHL_KIND_INSTANCE) {
                waiting[waiting_count] = child & SAHL_CHILD_OFFSET_MASK;
                waiting_groups[waiting_count] = met;
                ++waiting_count;
                continue;
            }
            bool taken = false;
            SAHL_COUNT_BLOCK(bvh, child_kind(child), SAHL_GROUP_RAYS * popcount(met));
            if (child_kind(child) == SAHL_KIND_TRIANGLE) {
                const global TriangleBlock* block = (const global TriangleBlock*)leaf_block(bvh, child);
                LazyPlanes planes;
                planes.known = false;
                float shifted[48];
                if (pass.axes.common_origin) {
                    const global float* axes = (const global float*)block;
                    vstore16(vload16(pass.axes.kx, axes) - pass.axes.origin[pass.axes.kx], 0, shifted);
                    vstore16(vload16(pass.axes.ky, axes) - pass.axes.origin[pass.axes.ky], 1, shifted);
                    vstore16(vload16(pass.axes.kz, axes) - pass.axes.origin[pass.axes.kz], 2, shifted);
                }
                for (; met != 0u; met &= met - 1u) {
                    uint g = lowest_lane(met);
                    if (intersect_triangles_group(block, &planes, shifted, rays + g, &pass.axes, far + g,
                                                  hits + g, any_hit)) {
                        cull_far[g] = far[g] * SAHL_CULL_SLACK;
                        group_far[g] = greatestg(cull_far[g]);
                        taken = true;
                    }
                }
            } else {
                for (; met != 0u; met &= met - 1u) {
                    uint g = lowest_lane(met);
                    const GroupTest test = {rays + g, &pass.axes, far + g, hits + g, any_hit};
                    if (intersect_shapes_group(bvh, child, &test)) {
                        cull_far[g] = far[g] * SAHL_CULL_SLACK;
                        group_far[g] = greatestg(cull_far[g]);
                        taken = true;
                    }
                }
            }
            if (taken) {
                pass.farthest = group_far[0];
                for (uint g = 1; g < SAHL_PACKET_GROUPS; ++g) {
                    pass.farthest = SAHL_MAX(pass.farthest, group_far[g]);
                }
                if (any_hit && !(pass.farthest > 0.0f)) {
                    size = base;
                }
            }
        }
        for (uint g = 0; g < SAHL_PACKET_GROUPS; ++g) {
            LaneMask active = equalg(pass_numbers[level][g], (intg)((int)number));
            hits[g].t = selectg(active, far[g], hits[g].t);
        }
        if (size == base) {
            passes &= passes - 1u;
        }
    }
}

/// The first hits of a packet's rays.
SAHL_NOINLINE void intersect_packet_of_rays(const Bvh* bvh, Packet* packet) {
    trace_packet(bvh, packet, false);
}

/// Fills list->occlusion.
SAHL_NOINLINE void occlude_by_packets(const Bvh* bvh, ShadowRays* list) {
    for (uint first = 0; first < list->count; first += SAHL_PACKET_RAYS) {
        Packet packet;
        load_shadow_packet(&packet, list, first);
        trace_packet(bvh, &packet, true);
        store_occlusion(&packet, list, first);
    }
}

#endif
