// Children -> the next generation's batch, in stable order: all reflected rays in the order of
// their parents, then all transmitted ones. What the next batch cannot hold goes to a second batch,
// which waits its turn.
//
// Three steps over blocks of SAHL_COMPACT_BLOCK parents: count the children of each block, sum the
// counts (one work-item: there are few blocks), move the rays.

#include "kernels/ray_batch.h"

kernel void count_children(const global uint* outcomes, global uint* block_counts,
                           global uint* block_shadow_rays, const uint count, const uint block_count) {
    const uint block = (uint)get_global_id(0);
    if (block >= block_count) {
        return;
    }
    uint reflected = 0, transmitted = 0, shadow_rays = 0;
    const uint end = SAHL_MIN((block + 1u) * SAHL_COMPACT_BLOCK, count);
    for (uint i = block * SAHL_COMPACT_BLOCK; i < end; ++i) {
        uint outcome = outcomes[i];
        reflected += (outcome & SAHL_OUTCOME_REFLECTED) != 0u;
        transmitted += (outcome & SAHL_OUTCOME_TRANSMITTED) != 0u;
        shadow_rays += outcome / SAHL_OUTCOME_SHADOW_RAY;
    }
    block_counts[block] = reflected;
    block_counts[block_count + block] = transmitted;
    block_shadow_rays[block] = shadow_rays;
}

/// Turns the counts into positions. totals: children, shadow rays (low and high word).
kernel void sum_children(global uint* block_counts, const global uint* block_shadow_rays, global uint* totals,
                         const uint block_count) {
    if (get_global_id(0) != 0u) {
        return;
    }
    uint children = 0;
    for (uint k = 0; k < 2u * block_count; ++k) {
        uint in_block = block_counts[k];
        block_counts[k] = children;
        children += in_block;
    }
    ulong shadow_rays = 0;
    for (uint k = 0; k < block_count; ++k) {
        shadow_rays += block_shadow_rays[k];
    }
    totals[0] = children;
    totals[1] = (uint)shadow_rays;
    totals[2] = (uint)(shadow_rays >> 32);
}

/// Copies ray `from` of the children to ray `to` of the two batches together.
static inline void move_ray(const global float* children, const global uint* child_ids, uint from,
                            global float* next, global uint* next_ids, global float* waiting,
                            global uint* waiting_ids, uint capacity, uint to) {
    global float* rays = to < capacity ? next : waiting;
    global uint* ids = to < capacity ? next_ids : waiting_ids;
    uint slot = to < capacity ? to : to - capacity;
    for (uint k = 0; k < SAHL_RAY_FLOATS; ++k) {
        rays[(size_t)k * capacity + slot] = children[(size_t)k * capacity + from];
    }
    for (uint k = 0; k < SAHL_RAY_UINTS; ++k) {
        ids[(size_t)k * capacity + slot] = child_ids[(size_t)k * capacity + from];
    }
}

kernel void compact(const global float* children, const global uint* child_ids, const global uint* outcomes,
                    const global uint* block_counts, global float* next, global uint* next_ids,
                    global float* waiting, global uint* waiting_ids, const uint capacity, const uint count,
                    const uint block_count) {
    const uint block = (uint)get_global_id(0);
    if (block >= block_count) {
        return;
    }
    const global float* transmitted = children + (size_t)SAHL_RAY_FLOATS * capacity;
    const global uint* transmitted_ids = child_ids + (size_t)SAHL_RAY_UINTS * capacity;
    uint to_reflected = block_counts[block], to_transmitted = block_counts[block_count + block];
    const uint end = SAHL_MIN((block + 1u) * SAHL_COMPACT_BLOCK, count);
    for (uint i = block * SAHL_COMPACT_BLOCK; i < end; ++i) {
        if (outcomes[i] & SAHL_OUTCOME_REFLECTED) {
            move_ray(children, child_ids, i, next, next_ids, waiting, waiting_ids, capacity, to_reflected++);
        }
        if (outcomes[i] & SAHL_OUTCOME_TRANSMITTED) {
            move_ray(transmitted, transmitted_ids, i, next, next_ids, waiting, waiting_ids, capacity,
                     to_transmitted++);
        }
    }
}
