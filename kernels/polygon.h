// Ray intersection with planar polygons, convex or concave, one ray against a block of four.
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
SAHL_DEFINE_CROSS_EDGE(float, int)
SAHL_DEFINE_CROSS_EDGE(float16, int16)

/// Whether the ray passes through the polygon or exactly through its outline; lo, hi: its box.
static inline bool polygon_contains(const global float* vertices, uint count, const RayShear* shear,
                                    float* lo, float* hi) {
    int inside = 0, on_outline = 0;
    float ax = 0.0f, ay = 0.0f;
    float3 least = INFINITY, greatest = -INFINITY;
    // Once around, from the last vertex.
    const global float* vertex = vertices + 3u * (count - 1u);
    for (uint i = 0; i <= count; ++i) {
        float z = vertex[shear->kz] - shear->oz;
        float bx = fma(z, shear->sx, vertex[shear->kx] - shear->ox);
        float by = fma(z, shear->sy, vertex[shear->ky] - shear->oy);
        if (i > 0u) {
            cross_edge(ax, ay, bx, by, &inside, &on_outline);
        }
        least = min3(least, load3(vertex));
        greatest = max3(greatest, load3(vertex));
        ax = bx;
        ay = by;
        vertex = vertices + 3u * i;
    }
    vstore3(least, 0, lo);
    vstore3(greatest, 0, hi);
    return (inside | on_outline) != 0;
}

static inline void intersect_polygons(const global PolygonBlock* block, const global float* polygon_vertices,
                                      const Ray* ray, const RayShear* shear, const RayBoxTest* boxes,
                                      HitState* state, bool any_hit) {
    float3 o = ray->origin, d = ray->direction;
    float4 nd, doubt;
    float4 t = cross_planes(vload4(0, block->normal_x), vload4(0, block->normal_y),
                            vload4(0, block->normal_z), vload4(0, block->x) - o.x, vload4(0, block->y) - o.y,
                            vload4(0, block->z) - o.z, (float4)(d.x), (float4)(d.y), (float4)(d.z),
                            (float4)(fabs(o.x) + fabs(o.y) + fabs(o.z)), &nd, &doubt);
    // NaN (a ray in the plane) passes.
    uint lanes = mask4(~((t < state->t_min - doubt) | (t > state->t + doubt)) &
                       (vload4(0, block->vertex_count) != 0u));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        uint id = block->id[lane];
        const global float* vertices = polygon_vertices + 3u * block->first_vertex[lane];
        float lo[3], hi[3];
        if ((id & SAHL_ID_MASK) != ray->exclude && is_seen_from(id, ((float*)&nd)[lane] <= 0.0f) &&
            polygon_contains(vertices, block->vertex_count[lane], shear, lo, hi)) {
            offer_hit(state, keep_to_box(((float*)&t)[lane], lo, hi, boxes), 0.0f, 0.0f, id, any_hit);
        }
    }
}

#endif
