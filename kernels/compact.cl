// Children -> the next generation's batch, in stable order: all reflected rays in the order of
// their parents, then all transmitted ones. What the next batch cannot hold goes to a second batch,
// which waits its turn.
//
// Three steps over blocks of SAHL_COMPACT_BLOCK parents: count the children of each block, sum the
// counts (one work-item: there are few blocks), move the rays. While these are at hand it is found out
// how far neighbours keep together: by how many ways a block's children go, which decides how the next
// generation is traced.

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

/// Turns the counts into positions, and sets all totals (SAHL_TOTAL_*).
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
    totals[SAHL_TOTAL_CHILDREN] = children;
    totals[SAHL_TOTAL_SHADOW_RAYS] = (uint)shadow_rays;
    totals[SAHL_TOTAL_SHADOW_RAYS + 1u] = (uint)(shadow_rays >> 32);
    totals[SAHL_TOTAL_WAYS] = 0;
    totals[SAHL_TOTAL_FAMILIES] = 0;
}

/// Copies `count` numbers of `from`, the places of which are given, to positions `to` and on of two arrays
/// together, the first of which is `capacity` long.
static inline void move_numbers(const global uint* from, const uint* place, uint count, global uint* next,
                                global uint* waiting, uint capacity, uint to) {
    const uint fitting = to < capacity ? SAHL_MIN(count, capacity - to) : 0u;
    if (count > 0u && fitting == count && place[count - 1u] - place[0] == count - 1u) {
        // Side by side, as where all of a block's rays are reflected.
        const global uint* source = from + place[0];
        uint k = 0;
        for (; k + 8u <= count; k += 8u) {
            vstore8(vload8(0, source + k), 0, next + to + k);
        }
        for (; k < count; ++k) {
            next[to + k] = source[k];
        }
        return;
    }
    for (uint k = 0; k < fitting; ++k) {
        next[to + k] = from[place[k]];
    }
    for (uint k = fitting; k < count; ++k) {
        waiting[to + k - capacity] = from[place[k]];
    }
}

/// Where children of one kind come from and go to.
typedef struct {
    const global uint* rays;  // floats' bits
    const global uint* ids;
    uint place[SAHL_COMPACT_BLOCK];
    uint count;
    uint to;
} Moved;

static inline void move_rays(const Moved* moved, global uint* next, global uint* next_ids,
                             global uint* waiting, global uint* waiting_ids, uint capacity) {
    for (uint k = 0; k < SAHL_RAY_FLOATS; ++k) {
        const size_t array = (size_t)k * capacity;
        move_numbers(moved->rays + array, moved->place, moved->count, next + array, waiting + array, capacity,
                     moved->to);
    }
    for (uint k = 0; k < SAHL_RAY_UINTS; ++k) {
        const size_t array = (size_t)k * capacity;
        move_numbers(moved->ids + array, moved->place, moved->count, next_ids + array, waiting_ids + array,
                     capacity, moved->to);
    }
}

/// One bit for each way of the children: its octant and the axis that it goes along most, as packets have
/// them in passes (packet.h).
static inline uint ways_of(const Moved* moved, uint capacity) {
    const global uint* directions = moved->rays + (size_t)SAHL_RAY_DIRECTION * capacity;
    uint ways = 0;
    for (uint k = 0; k < moved->count; ++k) {
        const global uint* direction = directions + moved->place[k];
        const uint x = direction[0], y = direction[capacity], z = direction[2u * (size_t)capacity];
        // Of floats without their sign, larger ones are larger words.
        const uint length_x = x & 0x7fffffffu, length_y = y & 0x7fffffffu, length_z = z & 0x7fffffffu;
        const uint axis =
            length_x >= length_y && length_x >= length_z ? 0u : (length_y >= length_z ? 8u : 16u);
        ways |= 1u << (axis + (x >> 31) + 2u * (y >> 31) + 4u * (z >> 31));
    }
    return ways;
}

kernel void compact(const global uint* children, const global uint* child_ids, const global uint* outcomes,
                    const global uint* block_counts, global uint* next, global uint* next_ids,
                    global uint* waiting, global uint* waiting_ids, global uint* totals, const uint capacity,
                    const uint count, const uint block_count) {
    const uint block = (uint)get_global_id(0);
    if (block >= block_count) {
        return;
    }
    Moved reflected = {.rays = children, .ids = child_ids, .to = block_counts[block]};
    Moved transmitted = {.rays = children + (size_t)SAHL_RAY_FLOATS * capacity,
                         .ids = child_ids + (size_t)SAHL_RAY_UINTS * capacity,
                         .to = block_counts[block_count + block]};
    const uint end = SAHL_MIN((block + 1u) * SAHL_COMPACT_BLOCK, count);
    for (uint i = block * SAHL_COMPACT_BLOCK; i < end; ++i) {
        // A place that does not count is overwritten by the next that does.
        const uint outcome = outcomes[i];
        reflected.place[reflected.count] = i;
        reflected.count += (outcome & SAHL_OUTCOME_REFLECTED) != 0u;
        transmitted.place[transmitted.count] = i;
        transmitted.count += (outcome & SAHL_OUTCOME_TRANSMITTED) != 0u;
    }
    move_rays(&reflected, next, next_ids, waiting, waiting_ids, capacity);
    move_rays(&transmitted, next, next_ids, waiting, waiting_ids, capacity);
    const uint families = (reflected.count > 0u) + (transmitted.count > 0u);
    if (families > 0u) {
        const uint ways = popcount(ways_of(&reflected, capacity)) + popcount(ways_of(&transmitted, capacity));
        atomic_add(totals + SAHL_TOTAL_WAYS, ways);
        atomic_add(totals + SAHL_TOTAL_FAMILIES, families);
    }
}
