// Traversal of the 8-wide tree by one ray at a time: a node's eight boxes in one step, leaves of
// four primitives in one step, a stack of waiting children in private memory. A leaf that is an
// instance sends the ray, transformed, through the tree of its group, on the same stack.
//
// Children are visited in the order of their slots permuted by the ray's octant, which is front to
// back (Ylitie, Karras, Laine 2017, sec. 3.2), so that nothing is sorted; waiting children behind
// the hit are dropped when they are popped.
// Pro: any device, any ray, one body for closest and any hit. Con: each node step waits for its
// memory; nothing is shared between neighbouring rays.
#ifndef SAHL_TRAVERSE_SCALAR_H
#define SAHL_TRAVERSE_SCALAR_H

#include "kernels/bvh.h"
#include "kernels/instance.h"
#include "kernels/polygon.h"
#include "kernels/quadric.h"
#include "kernels/shadow_rays.h"
#include "kernels/sphere.h"
#include "kernels/triangle.h"

static inline uint child_kind(uint child) { return child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK; }

static inline const global uchar* leaf_block(const Bvh* bvh, uint child) {
    return bvh->leaves + (ulong)(child & SAHL_CHILD_OFFSET_MASK) * SAHL_LEAF_LINE_BYTES;
}

/// Asks for the memory of a child, node or leaf: four lines. Which of them it is no processor can predict, so
/// both places are found and one is chosen.
static inline void prefetch_child(const Bvh* bvh, uint child) {
    const ulong node = (ulong)bvh->nodes + (ulong)child * sizeof(BvhNode);
    const ulong leaf = (ulong)bvh->leaves + (ulong)(child & SAHL_CHILD_OFFSET_MASK) * SAHL_LEAF_LINE_BYTES;
    prefetch_lines((const global void*)(child & SAHL_CHILD_LEAF ? leaf : node), 4u);
}

static inline void intersect_leaf(const Bvh* bvh, uint child, const Ray* ray, const RayShear* shear,
                                  const RayBoxTest* boxes, HitState* state, bool any_hit) {
    const global uchar* block = leaf_block(bvh, child);
    SAHL_COUNT_BLOCK(bvh, child_kind(child), 1u);
    switch (child_kind(child)) {
        case SAHL_KIND_TRIANGLE:
            intersect_triangles((const global TriangleBlock*)block, ray, shear, boxes, state, any_hit);
            break;
        case SAHL_KIND_SPHERE:
            intersect_spheres((const global SphereBlock*)block, ray, state, any_hit);
            break;
        case SAHL_KIND_ELLIPSOID:
            intersect_ellipsoids((const global QuadricBlock*)block, ray, state, any_hit);
            break;
        case SAHL_KIND_CONE:
            intersect_cones((const global QuadricBlock*)block, ray, state, any_hit);
            break;
        case SAHL_KIND_POLYGON:
            intersect_polygon((const global PolygonBlock*)block, bvh->outlines, ray, shear, boxes, state,
                              any_hit);
            break;
        case SAHL_KIND_SOLID_CONE:
            intersect_solid_cones((const global QuadricBlock*)block, ray, state, any_hit);
            break;
        case SAHL_KIND_DISC:
            intersect_discs((const global QuadricBlock*)block, ray, state, any_hit);
            break;
        case SAHL_KIND_BOX:
            intersect_boxes((const global QuadricBlock*)block, ray, state, any_hit);
            break;
    }
}

/// A ray with what its tests against boxes and triangles need.
typedef struct {
    Ray ray;
    RayBoxTest boxes;
    RayShear shear;
} TracedRay;

/// `exclude` is left out only where `instance` is the one that the ray starts on.
SAHL_INLINE TracedRay traced_ray(float3 origin, float3 direction, const Ray* ray, uint instance,
                                 float extent) {
    TracedRay traced;
    traced.ray.origin = origin;
    traced.ray.direction = direction;
    traced.ray.exclude = ray->instance == instance ? ray->exclude : SAHL_NO_PRIMITIVE;
    traced.ray.instance = instance;
    traced.boxes = ray_box_test(origin, direction, extent);
    traced.shear = ray_shear(origin, direction);
    return traced;
}

/// The ray in the space of the group of `bvh->instances[i]`.
static inline TracedRay traced_in_instance(const Bvh* bvh, const Ray* ray, uint i) {
    const global DeviceInstance* instance = bvh->instances + i;
    return traced_ray(round3(group_from_world_point(instance, convert_real3(ray->origin))),
                      round3(group_from_world_vector(instance, convert_real3(ray->direction))), ray, i + 1u,
                      instance->extent);
}

/// Brings the hits of `state`'s range into `state`: the first one, or with any_hit what kinds of
/// surface there are (it stops at an opaque one). Rays that cannot be traced meet nothing.
SAHL_INLINE void traverse(const Bvh* bvh, const Ray* ray, HitState* state, bool any_hit) {
    if (!can_meet_anything(ray)) {
        return;
    }
    const TracedRay in_world = traced_ray(ray->origin, ray->direction, ray, SAHL_WORLD, bvh->extent);
    TracedRay here = in_world;
    WaitingChild waiting[SAHL_LEVELS * SAHL_STACK_SIZE];
    uint size = 0;
    uint world_size = 0;  // what of it waits in the world while the ray is in an instance
    uint current = 0;
    float cull_t = state->t * SAHL_CULL_SLACK;
    for (;;) {
        if ((current & SAHL_CHILD_LEAF) && child_kind(current) == SAHL_KIND_INSTANCE) {
            const uint i = current & SAHL_CHILD_OFFSET_MASK;
            const TracedRay inside = traced_in_instance(bvh, ray, i);
            if (can_meet_anything(&inside.ray)) {
                here = inside;
                state->inside_of = i + 1u;
                world_size = size;
                current = bvh->instances[i].root;
                continue;
            }
        } else if (current & SAHL_CHILD_LEAF) {
            intersect_leaf(bvh, current, &here.ray, &here.shear, &here.boxes, state, any_hit);
            if (any_hit && (state->occlusion & SAHL_HIT_OPAQUE)) {
                return;
            }
            cull_t = state->t * SAHL_CULL_SLACK;
            SAHL_COUNT(bvh, SAHL_COUNT_FLOP, 1u);
        } else {
            const global BvhNode* node = bvh->nodes + current;
            float8 enter, leave;
            SAHL_COUNT_NODE(bvh, SAHL_NODE_FLOP);
            intersect_children(node, &here.boxes, state->t_min, cull_t, &enter, &leave);
            size = (uint)(push_children(node, enter, leave, &here.boxes, waiting + size) - waiting);
        }
        do {
            if (state->inside_of != SAHL_WORLD && size == world_size) {
                here = in_world;
                state->inside_of = SAHL_WORLD;
            }
            if (size == 0u) {
                return;
            }
            --size;
        } while (waiting[size].entry > cull_t);
        current = waiting[size].child;
    }
}

/// The first hit with t_min < t < t_max; its primitive is SAHL_NO_PRIMITIVE when there is none.
SAHL_NOINLINE HitState closest_hit(const Bvh* bvh, const Ray* ray, HitState range) {
    traverse(bvh, ray, &range, false);
    return range;
}

/// The first hits of range, as many as `crossings` have room for.
SAHL_NOINLINE void collect_crossings(const Bvh* bvh, const Ray* ray, HitState range, Crossings* crossings) {
    CollectedCrossings collected;
    collected.state = range;
    collected.state.occlusion = SAHL_HIT_COLLECT;
    collected.crossings.count = 0;
    traverse(bvh, ray, &collected.state, false);
    *crossings = collected.crossings;
}

/// SAHL_HIT_OPAQUE, SAHL_HIT_TRANSPARENT (at least one, nothing opaque) or SAHL_HIT_NOTHING in
/// 0 < t < t_max.
SAHL_NOINLINE uint any_hit(const Bvh* bvh, const Ray* ray, float t_max) {
    HitState state = hit_state(0.0f, t_max);
    traverse(bvh, ray, &state, true);
    return strongest_occlusion(state.occlusion);
}

#endif
