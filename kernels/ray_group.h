// A group of rays side by side, as structure of arrays, and their hits.
#ifndef SAHL_RAY_GROUP_H
#define SAHL_RAY_GROUP_H

#include "kernels/bvh.h"
#include "kernels/hit.h"
#include "kernels/simd.h"

/// Rays in the space of one tree, with what their tests against boxes and triangles need (see
/// RayBoxTest and RayShear).
typedef struct {
    floatg origin[3], direction[3];
    floatg inverse[3], addend[3], slack[3];  // RayBoxTest's addends are addend - slack and addend + slack
    floatg shear_x, shear_y;                 // for the axes of the pass that is under way
    intg exclude;  // the primitive of this tree that they start on, or SAHL_NO_PRIMITIVE
} RayGroup;

/// What the rays have met so far: hits with 0 < t, ordered as in HitState.
typedef struct {
    floatg t;
    floatg u, v;
    intg primitive;  // -1 while there is none, before all others in the order of ties
    intg instance;
    intg occlusion;        // any hit only: SAHL_HIT_*
    Crossings* crossings;  // any hit only: if not null, of rays that have met transparent surfaces
    intg start_primitive, start_instance;
} GroupHits;

static inline float lane_of(floatg v, uint lane) { return ((const float*)&v)[lane]; }

static inline void set_lane(RayGroup* rays, GroupHits* hits, uint lane, const Ray* ray, float t_max) {
    ((float*)&rays->origin[0])[lane] = ray->origin.x;
    ((float*)&rays->origin[1])[lane] = ray->origin.y;
    ((float*)&rays->origin[2])[lane] = ray->origin.z;
    ((float*)&rays->direction[0])[lane] = ray->direction.x;
    ((float*)&rays->direction[1])[lane] = ray->direction.y;
    ((float*)&rays->direction[2])[lane] = ray->direction.z;
    ((float*)&hits->t)[lane] = t_max;
    ((int*)&hits->start_primitive)[lane] = (int)ray->exclude;
    ((int*)&hits->start_instance)[lane] = (int)ray->instance;
}

/// What ray_box_test() is for one ray.
static inline void prepare_box_tests(RayGroup* rays, float extent) {
    for (uint axis = 0; axis < 3u; ++axis) {
        floatg r = finite_inverse(rays->direction[axis]);
        floatg o = rays->origin[axis];
        floatg e = (fabs(o) + extent) * 0x1p-20f * fabs(r);
        rays->inverse[axis] = r;
        rays->addend[axis] = -(o * r);
        rays->slack[axis] = e;
    }
}

/// The lanes whose hit at `t` on a surface comes before the one they have.
static inline LaneMask come_before(const GroupHits* hits, floatg nearest, floatg t, int primitive,
                                   int instance) {
    LaneMask before = lessg(t, nearest);
    LaneMask ties = equalg(t, nearest);
    if (anyg(ties)) {
        LaneMask lower =
            lessg((intg)(instance), hits->instance) |
            (equalg((intg)(instance), hits->instance) & lessg((intg)(primitive), hits->primitive));
        before |= ties & lower;
    }
    return before;
}

/// The lanes that see surface `id`: `front` are those that come from its front.
static inline LaneMask seen_from_group(uint id, LaneMask front) {
    LaneMask seen = equalg((intg)(0), (intg)(0));
    seen = id & SAHL_ID_BACK_ONLY ? notg(front) : seen;
    return id & SAHL_ID_FRONT_ONLY ? seen & front : seen;
}

/// Remembers where the rays `lanes` meet a transparent surface. `occlusion`: what they have met before.
SAHL_NOINLINE void keep_crossings(Crossings* crossings, const intg* occlusion, uint lanes, const floatg* t,
                                  ulong rank) {
    for (; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = lowest_lane(lanes);
        if (((const uint*)occlusion)[lane] == SAHL_HIT_NOTHING) {
            crossings[lane].count = 0;
        }
        insert_crossing(crossings + lane, lane_of(*t, lane), rank);
    }
}

/// Gives the rays `lanes` hits on surface `id` of `instance`; for shadow rays (any_hit) only what kind of
/// surface that is, and an opaque one ends their range at -inf. Returns whether a range has changed.
static inline bool take_hits(GroupHits* hits, floatg* far, LaneMask lanes, floatg t, floatg u, floatg v,
                             uint id, uint instance, bool any_hit) {
    if (any_hit) {
        bool transparent = (id & SAHL_ID_TRANSPARENT) != 0u;
        int met = transparent ? SAHL_HIT_TRANSPARENT : SAHL_HIT_OPAQUE;
        if (transparent && hits->crossings != 0) {
            keep_crossings(hits->crossings, &hits->occlusion, bitsg(lanes), &t,
                           surface_rank(instance, id & SAHL_ID_MASK));
        }
        hits->occlusion = selectg(lanes, hits->occlusion | (intg)(met), hits->occlusion);
        if (!transparent) {
            *far = selectg(lanes, (floatg)(-INFINITY), *far);
        }
        return !transparent;
    }
    *far = selectg(lanes, t, *far);
    hits->u = selectg(lanes, u, hits->u);
    hits->v = selectg(lanes, v, hits->v);
    hits->primitive = selectg(lanes, (intg)((int)(id & SAHL_ID_MASK)), hits->primitive);
    hits->instance = selectg(lanes, (intg)((int)instance), hits->instance);
    return true;
}

#endif
