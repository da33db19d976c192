// Sixteen rays side by side, as structure of arrays, and their hits.
#ifndef SAHL_RAY_GROUP_H
#define SAHL_RAY_GROUP_H

#include "kernels/bvh.h"
#include "kernels/hit.h"
#include "kernels/simd.h"

/// Rays in the space of one tree, with what their tests against boxes and triangles need (see
/// RayBoxTest and RayShear).
typedef struct {
    float16 origin[3], direction[3];
    float16 inverse[3], addend[3], slack[3];  // RayBoxTest's addends are addend - slack and addend + slack
    float16 shear_x, shear_y;                 // for the axes of the pass that is under way
    int16 exclude;  // the primitive of this tree that they start on, or SAHL_NO_PRIMITIVE
} RayGroup;

/// What the rays have met so far: hits with 0 < t, ordered as in HitState.
typedef struct {
    float16 t;
    float16 u, v;
    int16 primitive;  // -1 while there is none, before all others in the order of ties
    int16 instance;
    int16 occlusion;  // any hit only: SAHL_HIT_*
    int16 start_primitive, start_instance;
} GroupHits;

static inline float lane_of(float16 v, uint lane) { return ((const float*)&v)[lane]; }

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

/// 1/d, with ±1e18 for components that are (nearly) 0, as finite_inverse().
static inline float16 finite_inverse16(float16 d) {
    float16 magnitude = fabs(d);
    magnitude = magnitude < 1e-18f ? (float16)(1e-18f) : magnitude;
    return as_float16(as_int16(1.0f / magnitude) | (as_int16(d) & (int16)(0x80000000)));
}

/// What ray_box_test() is for one ray.
static inline void prepare_box_tests(RayGroup* rays, float extent) {
    for (uint axis = 0; axis < 3u; ++axis) {
        float16 r = finite_inverse16(rays->direction[axis]);
        float16 o = rays->origin[axis];
        float16 e = (fabs(o) + extent) * 0x1p-20f * fabs(r);
        rays->inverse[axis] = r;
        rays->addend[axis] = -(o * r);
        rays->slack[axis] = e;
    }
}

/// can_meet_anything() for sixteen rays.
static inline Lanes16 are_traceable(const RayGroup* rays) {
    const float16* o = rays->origin;
    const float16* d = rays->direction;
    const float16 sum = (o[0] + o[1] + o[2]) * 0.0f + (d[0] + d[1] + d[2]) * 0.0f;
    const float16 length = SAHL_MAX(SAHL_MAX(fabs(d[0]), fabs(d[1])), fabs(d[2]));
    const float16 offset = SAHL_MAX(SAHL_MAX(fabs(o[0]), fabs(o[1])), fabs(o[2]));
    return equal16(sum, (float16)(0.0f)) & less_equal16((float16)(SAHL_SHORTEST_DIRECTION), length) &
           less_equal16(length, (float16)(SAHL_LARGEST_COORDINATE)) &
           less_equal16(offset, (float16)(SAHL_LARGEST_COORDINATE));
}

/// The lanes whose hit at `t` on a surface comes before the one they have.
static inline Lanes16 come_before(const GroupHits* hits, float16 nearest, float16 t, int primitive,
                                  int instance) {
    Lanes16 before = less16(t, nearest);
    Lanes16 ties = equal16(t, nearest);
    if (any16(ties)) {
        Lanes16 lower =
            less16((int16)(instance), hits->instance) |
            (equal16((int16)(instance), hits->instance) & less16((int16)(primitive), hits->primitive));
        before |= ties & lower;
    }
    return before;
}

/// The lanes that see surface `id`: `front` are those that come from its front.
static inline Lanes16 seen_from16(uint id, Lanes16 front) {
    Lanes16 seen = equal16((int16)(0), (int16)(0));
    seen = id & SAHL_ID_BACK_ONLY ? not16(front) : seen;
    return id & SAHL_ID_FRONT_ONLY ? seen & front : seen;
}

/// Gives the rays `lanes` hits on surface `id` of `instance`; for shadow rays (any_hit) only what kind of
/// surface that is, and an opaque one ends their range at -inf. Returns whether a range has changed.
static inline bool take_hits(GroupHits* hits, float16* far, Lanes16 lanes, float16 t, float16 u, float16 v,
                             uint id, uint instance, bool any_hit) {
    if (any_hit) {
        bool transparent = (id & SAHL_ID_TRANSPARENT) != 0u;
        int met = transparent ? SAHL_HIT_TRANSPARENT : SAHL_HIT_OPAQUE;
        hits->occlusion = select16(lanes, hits->occlusion | (int16)(met), hits->occlusion);
        if (!transparent) {
            *far = select16(lanes, (float16)(-INFINITY), *far);
        }
        return !transparent;
    }
    *far = select16(lanes, t, *far);
    hits->u = select16(lanes, u, hits->u);
    hits->v = select16(lanes, v, hits->v);
    hits->primitive = select16(lanes, (int16)((int)(id & SAHL_ID_MASK)), hits->primitive);
    hits->instance = select16(lanes, (int16)((int)instance), hits->instance);
    return true;
}

#endif
