// Ray intersection with a planar polygon, convex or concave: one ray, seven edges at a time.
//
// The distance comes from the plane, kept to the polygon's box as for triangles. Inside or outside is decided
// by crossings of the sheared vertices (the shear of triangle.h) with the half-axis y = 0, x > 0; edge
// functions are computed as for triangles and edges of value 0 count as inside, so polygons that share edges
// with polygons or triangles leak nothing between them.
#ifndef SAHL_POLYGON_H
#define SAHL_POLYGON_H

#include "kernels/crossings.h"
#include "kernels/hit.h"
#include "kernels/simd.h"
#include "kernels/triangle.h"

// What the edge from a to b, in rays' shears, adds to `inside` (whether the half-axis has been crossed an
// odd number of times) and `on_outline`: 0 or not, of scalars and of the lanes of vectors.
#define SAHL_DEFINE_CROSS_EDGE(Floats, Ints)                                                      \
    SAHL_OVERLOAD void cross_edge(Floats ax, Floats ay, Floats bx, Floats by, Ints* inside,       \
                                  Ints* on_outline) {                                             \
        Floats edge = ax * by - ay * bx;                                                          \
        *on_outline |= (edge == 0.0f) & (SAHL_MIN(ax, bx) <= 0.0f) & (SAHL_MAX(ax, bx) >= 0.0f) & \
                       (SAHL_MIN(ay, by) <= 0.0f) & (SAHL_MAX(ay, by) >= 0.0f);                   \
        *inside ^= ((ay > 0.0f) != (by > 0.0f)) & ((edge > 0.0f) == (by > ay));                   \
    }
SAHL_DEFINE_CROSS_EDGE(float8, int8)
#if SAHL_GROUP_RAYS != 8
SAHL_DEFINE_CROSS_EDGE(floatg, intg)
#endif

static inline const global OutlineGroup* outline_of(const global PolygonBlock* block,
                                                    const global float* outlines) {
    return (const global OutlineGroup*)outlines + block->first_group;
}

/// Whether the ray passes through the polygon or exactly through its outline.
static inline bool polygon_contains(const global OutlineGroup* group, uint corner_count,
                                    const RayShear* shear) {
    int8 inside = 0, on_outline = 0;
    for (uint first = 0; first < corner_count; first += SAHL_OUTLINE_EDGES, ++group) {
        const global float* axes = (const global float*)group;
        const float8 z = vload8(shear->kz, axes) - shear->oz;
        const float8 x = fma(z, (float8)(shear->sx), vload8(shear->kx, axes) - shear->ox);
        const float8 y = fma(z, (float8)(shear->sy), vload8(shear->ky, axes) - shear->oy);
        // The last lane's edge goes nowhere: it changes nothing unless the ray meets a corner.
        cross_edge(x, y, x.s12345677, y.s12345677, &inside, &on_outline);
    }
    const int4 odd = inside.lo ^ inside.hi, on = on_outline.lo | on_outline.hi;
    return ((odd.x ^ odd.y ^ odd.z ^ odd.w) | on.x | on.y | on.z | on.w) != 0;
}

static inline void intersect_polygon(const global PolygonBlock* block, const global float* outlines,
                                     const Ray* ray, const RayShear* shear, const RayBoxTest* boxes,
                                     HitState* state, bool any_hit) {
    const float3 o = ray->origin, d = ray->direction;
    const uint id = block->id;
    float4 nd, doubt;
    const float t =
        cross_planes((float4)(block->normal[0]), (float4)(block->normal[1]), (float4)(block->normal[2]),
                     (float4)(block->point[0] - o.x), (float4)(block->point[1] - o.y),
                     (float4)(block->point[2] - o.z), (float4)(d.x), (float4)(d.y), (float4)(d.z),
                     (float4)(fabs(o.x) + fabs(o.y) + fabs(o.z)), &nd, &doubt)
            .x;
    // NaN (a ray in the plane) passes.
    if (t < state->t_min - doubt.x || t > state->t + doubt.x || (id & SAHL_ID_MASK) == ray->exclude ||
        !is_seen_from(id, nd.x <= 0.0f) ||
        !polygon_contains(outline_of(block, outlines), block->corner_count, shear)) {
        return;
    }
    float lo[3], hi[3];
    vstore3(load3(block->lo), 0, lo);
    vstore3(load3(block->hi), 0, hi);
    offer_hit(state, keep_to_box(t, lo, hi, boxes), 0.0f, 0.0f, id, any_hit);
}

#endif
