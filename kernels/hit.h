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
} Ray;

// Occlusion of a shadow ray.
#define SAHL_HIT_NOTHING 0u
#define SAHL_HIT_TRANSPARENT 1u
#define SAHL_HIT_OPAQUE 2u

/// What a ray has met so far. Hits are ordered by (t, primitive): a hit is taken when it comes
/// after (t_min, min_primitive) and before (t, before_primitive), so that every traversal order
/// ends with the same one, and walking on behind a hit meets each surface once.
typedef struct {
    float t_min;
    uint min_primitive;
    float t;
    uint before_primitive;
    float u, v;
    uint primitive;  // SAHL_NO_PRIMITIVE while there is none
    uint occlusion;  // any hit only
} HitState;

/// Hits with t_min < t < t_max.
static inline HitState hit_state(float t_min, float t_max) {
    HitState state = {t_min, SAHL_NO_PRIMITIVE, t_max, 0u, 0.0f, 0.0f, SAHL_NO_PRIMITIVE, SAHL_HIT_NOTHING};
    return state;
}

/// Hits of `state`'s range behind the one it holds.
static inline HitState hit_state_behind(HitState state, float t_max) {
    HitState next = hit_state(state.t, t_max);
    next.min_primitive = state.primitive;
    return next;
}

/// Offers a hit. A shadow ray (any_hit) keeps its range when it meets a transparent surface and
/// only remembers it. NaN distances are never taken.
static inline void offer_hit(HitState* state, float t, float u, float v, uint id, bool any_hit) {
    uint primitive = id & SAHL_ID_MASK;
    bool after = t > state->t_min || (t == state->t_min && primitive > state->min_primitive);
    bool before = t < state->t || (t == state->t && primitive < state->before_primitive);
    if (!(after && before)) {
        return;
    }
    if (any_hit) {
        state->occlusion |= (id & SAHL_ID_TRANSPARENT) ? SAHL_HIT_TRANSPARENT : SAHL_HIT_OPAQUE;
        return;
    }
    state->t = t;
    state->u = u;
    state->v = v;
    state->primitive = primitive;
    state->before_primitive = primitive;
}

/// Offers the two roots of a curved surface: where the ray enters the solid it bounds and where it
/// leaves. A ray that starts on the surface drops the root at its origin, a surface that is seen
/// from inside only drops the entering one.
static inline void offer_roots(HitState* state, float enter, bool enter_valid, float leave, bool leave_valid,
                               uint id, uint exclude, bool any_hit) {
    if ((id & SAHL_ID_MASK) == exclude) {
        bool enter_is_origin = fabs(enter) < fabs(leave);
        enter_valid = enter_valid && !enter_is_origin;
        leave_valid = leave_valid && enter_is_origin;
    }
    if (enter_valid && !(id & SAHL_ID_BACK_ONLY)) {
        offer_hit(state, enter, 0.0f, 0.0f, id, any_hit);
    }
    if (leave_valid && !(id & SAHL_ID_FRONT_ONLY)) {
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
