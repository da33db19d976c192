// Traversal of the 8-wide tree by a stream of single rays, for rays that go any way: diffuse bounces,
// reflections off curved surfaces.
//
// A work-item keeps SAHL_STREAM_WIDTH rays in flight and works on two lists in turn: rays whose next
// step is a node and rays whose next step is a leaf. Each step asks for the memory of the ray's next
// one, which has arrived when its turn comes, and steps of one kind in a row predict their branches
// well: that is the gain over one ray at a time (traverse_scalar.h), whose arithmetic this is. A ray
// that is done makes place for the next one.
// Source: the idea of many rays in flight per thread to hide latency is that of GPUs (Aila, Laine 2009,
// "Understanding the Efficiency of Ray Traversal on GPUs").
// Pro: indifferent to coherence. Con: nothing is shared between rays; traverse_packet.h does that.
#ifndef SAHL_TRAVERSE_STREAM_H
#define SAHL_TRAVERSE_STREAM_H

#include "kernels/stream_ray.h"
#include "kernels/traverse_scalar.h"

// More rays in flight hide more of what each waits for, but all have to fit into the nearest cache.
#ifdef SAHL_AVX512
#define SAHL_STREAM_WIDTH 32u
#else
#define SAHL_STREAM_WIDTH 20u
#endif

SAHL_STATIC_ASSERT(SAHL_STREAM_RAYS % SAHL_LANES == 0u && SAHL_SHADOW_RAYS % SAHL_LANES == 0u,
                   "rays are prepared SAHL_LANES at a time");

// Ends of stacks: of the ray's, and of an instance's part of it. They look like leaves.
#define SAHL_CHILD_END 0xffffffffu
#define SAHL_CHILD_LEAVE 0xfffffffeu

/// Waiting children. An odd number of cache lines, so that the stacks' bottoms do not compete for the same
/// sets of the cache.
typedef struct {
    WaitingChild waiting[SAHL_LEVELS * SAHL_STACK_SIZE + 8u];
} __attribute__((aligned(64))) StreamStack;

/// Rays whose next step is of one kind.
typedef struct {
    StreamRay* rays[SAHL_STREAM_WIDTH];
    uint count;
} StepList;

static inline void put_into_space(StreamRay* ray, const TracedRay* traced) {
    ray->boxes = traced->boxes;
    ray->ray = traced->ray;
    ray->shear = traced->shear;
}

static inline void push(StreamRay* ray, uint child, float entry) {
    ++ray->top;
    ray->top->child = child;
    ray->top->entry = entry;
}

/// Takes the waiting children that begin behind the hit off the stack.
static inline void drop_hidden(StreamRay* ray) {
    WaitingChild* top = ray->top;
    while (top->entry > ray->cull_t) {
        --top;
    }
    ray->top = top;
}

/// The rays of a source that have not set out yet.
typedef struct {
    // From next % SAHL_LANES on, unless that is 0, rays that are prepared; the others are free.
    StreamRay* places[SAHL_LANES];
    uint next, end;
} WaitingRays;

/// Has the next ray of the source set out on the stack of one that is done, whose place becomes free.
/// Returns 0 if there is none.
static inline StreamRay* start_ray(const Bvh* bvh, const RaySource* source, WaitingRays* waiting,
                                   StreamRay* done, bool any_hit) {
    if (waiting->next == waiting->end) {
        return 0;
    }
    const uint k = waiting->next % SAHL_LANES;
    if (k == 0u) {
        prepare_rays(source, waiting->next, bvh->extent, waiting->places, any_hit);
    }
    StreamRay* ray = waiting->places[k];
    waiting->places[k] = done;
    ++waiting->next;
    ray->bottom = done->bottom;
    ray->top = ray->bottom;
    push(ray, 0u, 0.0f);
    return ray;
}

static inline void finish_ray(const RaySource* source, const StreamRay* ray, bool any_hit) {
    if (any_hit) {
        source->shadow_rays->occlusion[ray->index] = strongest_occlusion(ray->state.occlusion);
    } else {
        store_hit(source->hits, source->hit_ids, source->capacity, ray->index, &ray->state);
    }
}

/// Opens the node on top of the stack.
static inline void visit_node(const Bvh* bvh, StreamRay* ray) {
    const global BvhNode* node = bvh->nodes + ray->top->child;
    float8 enter, leave;
    SAHL_COUNT_NODE(bvh, SAHL_NODE_FLOP);
    intersect_children(node, &ray->boxes, 0.0f, ray->cull_t, &enter, &leave);
    ray->top = push_children(node, enter, leave, &ray->boxes, ray->top) - 1;
}

/// Goes into the instance that was on top of the stack, or comes back out of it.
static inline void change_space(const Bvh* bvh, const RaySource* source, StreamRay* ray, uint child,
                                bool any_hit) {
    const Ray in_world = source_ray(source, ray->index, any_hit);
    if (child == SAHL_CHILD_LEAVE) {
        const TracedRay traced =
            traced_ray(in_world.origin, in_world.direction, &in_world, SAHL_WORLD, bvh->extent);
        put_into_space(ray, &traced);
        ray->state.inside_of = SAHL_WORLD;
        return;
    }
    const uint i = child & SAHL_CHILD_OFFSET_MASK;
    const TracedRay traced = traced_in_instance(bvh, &in_world, i);
    if (!can_meet_anything(&traced.ray)) {
        return;
    }
    put_into_space(ray, &traced);
    ray->state.inside_of = i + 1u;
    push(ray, SAHL_CHILD_LEAVE, -INFINITY);
    push(ray, bvh->instances[i].root, 0.0f);
}

/// Does what a leaf asks for. What is not a block of triangles is kept apart, so that
/// it takes no registers from these.
SAHL_NOINLINE void visit_other_leaf(const Bvh* bvh, const RaySource* source, StreamRay* ray, uint child,
                                    bool any_hit) {
    if (child_kind(child) >= SAHL_KIND_INSTANCE) {
        change_space(bvh, source, ray, child, any_hit);
    } else {
        intersect_leaf(bvh, child, &ray->ray, &ray->shear, &ray->boxes, &ray->state, any_hit);
    }
}

/// Takes the leaf on top off the stack and does what it asks for.
static inline void visit_leaf(const Bvh* bvh, const RaySource* source, StreamRay* ray, bool any_hit) {
    const uint child = ray->top->child;
    --ray->top;
    if (child_kind(child) == SAHL_KIND_TRIANGLE) {
        SAHL_COUNT_BLOCK(bvh, SAHL_KIND_TRIANGLE, 1u);
        intersect_triangles((const global TriangleBlock*)leaf_block(bvh, child), &ray->ray, &ray->shear,
                            &ray->boxes, &ray->state, any_hit);
    } else {
        visit_other_leaf(bvh, source, ray, child, any_hit);
    }
    ray->cull_t = ray->state.t * SAHL_CULL_SLACK;
    if (any_hit && (ray->state.occlusion & SAHL_HIT_OPAQUE)) {
        ray->top = ray->bottom;
    }
    drop_hidden(ray);
}

/// Puts a ray on the list of its next step and asks for the memory of that. Both lists are written and one
/// counts it: no branch.
SAHL_INLINE void enlist(const Bvh* bvh, StreamRay* ray, StepList* at_node, StepList* at_leaf) {
    const uint child = ray->top->child;
    prefetch_child(bvh, child);
    const uint leaf = child >> 31;
    at_node->rays[at_node->count] = ray;
    at_leaf->rays[at_leaf->count] = ray;
    at_node->count += 1u - leaf;
    at_leaf->count += leaf;
}

/// Traces rays first..end-1 of the source, `first` being a multiple of SAHL_LANES: the first hits, or with
/// any_hit what kinds of surfaces there are.
SAHL_INLINE void trace_stream(const Bvh* bvh, const RaySource* source, uint first, uint end, bool any_hit) {
    StreamRay places[SAHL_STREAM_WIDTH + SAHL_LANES];
    StreamStack stacks[SAHL_STREAM_WIDTH];
    WaitingRays waiting;
    waiting.next = first;
    waiting.end = end;
    for (uint k = 0; k < SAHL_LANES; ++k) {
        waiting.places[k] = places + SAHL_STREAM_WIDTH + k;
    }
    StepList at_node, at_leaf;
    at_node.count = 0u;
    at_leaf.count = 0u;
    for (uint k = 0; k < SAHL_STREAM_WIDTH && waiting.next < end; ++k) {
        places[k].bottom = stacks[k].waiting;
        places[k].bottom->child = SAHL_CHILD_END;
        places[k].bottom->entry = -INFINITY;
        at_leaf.rays[at_leaf.count++] = start_ray(bvh, source, &waiting, places + k, any_hit);
    }
    while (at_node.count + at_leaf.count != 0u) {
        const uint nodes = at_node.count;
        at_node.count = 0u;
        // A step's outcome is looked at when all have been begun, as nothing behind waits for it then.
        for (uint k = 0; k < nodes; ++k) {
            visit_node(bvh, at_node.rays[k]);
        }
        for (uint k = 0; k < nodes; ++k) {
            enlist(bvh, at_node.rays[k], &at_node, &at_leaf);
        }
        const uint leaves = at_leaf.count;
        at_leaf.count = 0u;
        for (uint k = 0; k < leaves; ++k) {
            StreamRay* ray = at_leaf.rays[k];
            const uint child = ray->top->child;
            if (child == SAHL_CHILD_END) {
                finish_ray(source, ray, any_hit);
                ray = start_ray(bvh, source, &waiting, ray, any_hit);
                if (ray == 0) {
                    continue;
                }
            } else if (child & SAHL_CHILD_LEAF) {
                visit_leaf(bvh, source, ray, any_hit);
            }
            enlist(bvh, ray, &at_node, &at_leaf);
        }
    }
}

/// The first hits of rays first..end-1 of a batch.
SAHL_NOINLINE void intersect_by_stream(const Bvh* bvh, const RaySource* source, uint first, uint end) {
    trace_stream(bvh, source, first, end, false);
}

/// Fills list->occlusion.
SAHL_NOINLINE void occlude_by_stream(const Bvh* bvh, ShadowRays* list) {
    const RaySource source = {0, 0, 0, 0, 0u, list};
    trace_stream(bvh, &source, 0u, list->count, true);
}

#endif
