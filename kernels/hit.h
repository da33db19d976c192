// A ray on its way through the scene and the rule by which it takes hits.
#ifndef SAHL_HIT_H
#define SAHL_HIT_H

#include "kernels/device_types.h"
#include "kernels/math.h"
#include "kernels/simd.h"

typedef struct {
    float3 origin;
    float3 direction;  // any length but 0
    uint exclude;      // the primitive it starts on, or SAHL_NO_PRIMITIVE
    uint instance;     // the instance of that primitive
} Ray;

// Rays meet nothing whose origin or direction is not finite or has a component beyond the first of these, or
// whose direction has none that reaches the second: their products would leave the range of floats. The same
// goes for what an instance's transform makes of them; they do not see that instance.
//
// Within that, all traversals take the same hits bit for bit where directions are 2^-24 to 2^40 long and
// primitives 1e-9 to 1e9 times as large, and from origins up to 1e4 times their size away (measured:
// test_traversals.cpp, test_instances.cpp). From up to 1e4/f for curved primitives that a transform, their
// own or an instance's, makes f times thinner than wide: further away their rounding is more than boxes have
// room for (bvh.h), and at ten times as far one ray in 1e4 meets or misses a rim as the traversal has it.
#define SAHL_LARGEST_COORDINATE 0x1p60f
#define SAHL_SHORTEST_DIRECTION 0x1p-40f

// Occlusion of a shadow ray.
#define SAHL_HIT_NOTHING 0u
#define SAHL_HIT_TRANSPARENT 1u
#define SAHL_HIT_OPAQUE 2u
// Not an occlusion: the state is the first member of CollectedCrossings, which take all hits.
#define SAHL_HIT_COLLECT 4u

/// Whether the ray is one that can be traced (SAHL_LARGEST_COORDINATE).
static inline bool can_meet_anything(const Ray* ray) {
    const float length = max_abs3(ray->direction);
    return isfinite(dot3(ray->direction, (float3)(1.0f))) && isfinite(dot3(ray->origin, (float3)(1.0f))) &&
           length >= SAHL_SHORTEST_DIRECTION && length <= SAHL_LARGEST_COORDINATE &&
           max_abs3(ray->origin) <= SAHL_LARGEST_COORDINATE;
}

/// can_meet_anything() for vectors of rays.
#define SAHL_DEFINE_ARE_TRACEABLE(FLOAT, INT)                                                                \
    SAHL_OVERLOAD INT are_traceable(const FLOAT* origin, const FLOAT* direction) {                           \
        const FLOAT sum = (origin[0] + origin[1] + origin[2]) * 0.0f +                                       \
                          (direction[0] + direction[1] + direction[2]) * 0.0f;                               \
        const FLOAT length = SAHL_MAX(SAHL_MAX(fabs(direction[0]), fabs(direction[1])), fabs(direction[2])); \
        const FLOAT offset = SAHL_MAX(SAHL_MAX(fabs(origin[0]), fabs(origin[1])), fabs(origin[2]));          \
        return (sum == 0.0f) & (length >= SAHL_SHORTEST_DIRECTION) & (length <= SAHL_LARGEST_COORDINATE) &   \
               (offset <= SAHL_LARGEST_COORDINATE);                                                          \
    }
SAHL_DEFINE_ARE_TRACEABLE(float8, int8)
SAHL_DEFINE_ARE_TRACEABLE(float16, int16)

/// A surface's place in the order of surfaces: by instance, then by primitive.
static inline ulong surface_rank(uint instance, uint primitive) { return (ulong)instance << 32 | primitive; }

/// What a ray has met so far. Hits are ordered by (t, rank): a hit is taken when it comes after
/// (t_min, min_rank) and before (t, before_rank), so that every traversal order ends with the same
/// one, and walking on behind a hit meets each surface once.
typedef struct {
    float t_min;
    ulong min_rank;
    float t;
    ulong before_rank;
    float u, v;
    uint primitive;  // SAHL_NO_PRIMITIVE while there is none
    uint instance;
    uint occlusion;  // any hit only
    uint inside_of;  // the instance that is being walked through
} HitState;

/// Hits with t_min < t < t_max.
static inline HitState hit_state(float t_min, float t_max) {
    HitState state = {
        t_min, ~0ul, t_max, 0ul, 0.0f, 0.0f, SAHL_NO_PRIMITIVE, SAHL_WORLD, SAHL_HIT_NOTHING, SAHL_WORLD};
    return state;
}

// More than most rays meet; the others walk on behind the last.
#define SAHL_MOST_CROSSINGS 8u

/// The first hits of a ray, in order.
typedef struct {
    float t[SAHL_MOST_CROSSINGS];
    ulong rank[SAHL_MOST_CROSSINGS];
    uint count;
} Crossings;

/// The first hits of state's range.
typedef struct {
    HitState state;
    Crossings crossings;
} CollectedCrossings;

/// Takes a hit into its place; where that is full, the last one makes room.
static inline void insert_crossing(Crossings* crossings, float t, ulong rank) {
    uint place = crossings->count;
    while (place > 0u && (t < crossings->t[place - 1u] ||
                          (t == crossings->t[place - 1u] && rank <= crossings->rank[place - 1u]))) {
        --place;
    }
    if (place == SAHL_MOST_CROSSINGS) {
        return;
    }
    if (place < crossings->count && t == crossings->t[place] && rank == crossings->rank[place]) {
        return;  // a triangle in two leaves
    }
    const uint last = SAHL_MIN(crossings->count, SAHL_MOST_CROSSINGS - 1u);
    for (uint k = last; k > place; --k) {
        crossings->t[k] = crossings->t[k - 1u];
        crossings->rank[k] = crossings->rank[k - 1u];
    }
    crossings->t[place] = t;
    crossings->rank[place] = rank;
    crossings->count = last + 1u;
}

/// The same for a hit of state's range: what lies behind a full list's last is of no interest any more.
static inline void collect_crossing(CollectedCrossings* collected, float t, ulong rank) {
    Crossings* crossings = &collected->crossings;
    insert_crossing(crossings, t, rank);
    if (crossings->count == SAHL_MOST_CROSSINGS) {
        collected->state.t = crossings->t[SAHL_MOST_CROSSINGS - 1u];
        collected->state.before_rank = crossings->rank[SAHL_MOST_CROSSINGS - 1u];
    }
}

/// Whether surface `id` is seen by a ray that comes from its front or its back.
static inline bool is_seen_from(uint id, bool front) {
    return !(id & (front ? SAHL_ID_BACK_ONLY : SAHL_ID_FRONT_ONLY));
}

/// Offers a hit. A shadow ray (any_hit) keeps its range when it meets a transparent surface and
/// only remembers it, CollectedCrossings gather all hits. NaN distances are never taken.
static inline void offer_hit(HitState* state, float t, float u, float v, uint id, bool any_hit) {
    uint primitive = id & SAHL_ID_MASK;
    ulong rank = surface_rank(state->inside_of, primitive);
    bool after = t > state->t_min || (t == state->t_min && rank > state->min_rank);
    bool before = t < state->t || (t == state->t && rank < state->before_rank);
    if (!(after && before)) {
        return;
    }
    if (any_hit) {
        state->occlusion |= (id & SAHL_ID_TRANSPARENT) ? SAHL_HIT_TRANSPARENT : SAHL_HIT_OPAQUE;
        return;
    }
    if (state->occlusion == SAHL_HIT_COLLECT) {
        collect_crossing((CollectedCrossings*)state, t, rank);
        return;
    }
    state->t = t;
    state->u = u;
    state->v = v;
    state->primitive = primitive;
    state->instance = state->inside_of;
    state->before_rank = rank;
}

/// Offers the two roots of a curved surface or a solid: where the ray enters the solid it bounds and
/// where it leaves. A ray that starts on the surface drops the root at its origin.
static inline void offer_roots(HitState* state, float enter, bool enter_valid, float leave, bool leave_valid,
                               uint id, uint exclude, bool any_hit) {
    if ((id & SAHL_ID_MASK) == exclude) {
        bool enter_is_origin = fabs(enter) < fabs(leave);
        enter_valid = enter_valid && !enter_is_origin;
        leave_valid = leave_valid && enter_is_origin;
    }
    if (enter_valid && is_seen_from(id, true)) {
        offer_hit(state, enter, 0.0f, 0.0f, id, any_hit);
    }
    if (leave_valid && is_seen_from(id, false)) {
        offer_hit(state, leave, 0.0f, 0.0f, id, any_hit);
    }
}

/// The roots of four closed surfaces, NaN where the ray misses one.
static inline void offer_chords(HitState* state, float4 enter, float4 leave, const global uint* ids,
                                uint exclude, bool any_hit) {
    uint lanes = mask4((enter <= state->t) & (leave >= state->t_min));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        offer_roots(state, ((float*)&enter)[lane], true, ((float*)&leave)[lane], true, ids[lane], exclude,
                    any_hit);
    }
}

#endif
