// Ray intersection with planar polygons, convex or concave, one ray against a block of four.
//
// The distance comes from the plane, kept to the polygon's box as for triangles. Inside or outside is decided
// by crossings of the sheared vertices (the shear of triangle.h) with the half-axis y = 0, x > 0; edge
// functions are computed as for triangles and edges of value 0 count as inside, so polygons that share edges
// with polygons or triangles leak nothing between them.
#ifndef SAHL_POLYGON_H
#define SAHL_POLYGON_H

#include "kernels/hit.h"
#include "kernels/simd.h"
#include "kernels/triangle.h"

/// A vertex in the ray's shear.
static inline float2 sheared_vertex(float3 vertex, const RayShear* shear) {
    float z = component(vertex, shear->kz) - shear->oz;
    return (float2)(fma(z, shear->sx, component(vertex, shear->kx) - shear->ox),
                    fma(z, shear->sy, component(vertex, shear->ky) - shear->oy));
}

/// Whether the ray passes through the polygon or exactly through its outline; *lo, *hi: its box.
static inline bool polygon_contains(const global float* vertices, uint count, const RayShear* shear,
                                    float* lo, float* hi) {
    bool inside = false, on_outline = false;
    float3 last = load3(vertices + 3u * (count - 1u));
    float2 a = sheared_vertex(last, shear);
    vstore3(last, 0, lo);
    vstore3(last, 0, hi);
    for (uint i = 0; i < count; ++i) {
        float3 vertex = load3(vertices + 3u * i);
        float2 b = sheared_vertex(vertex, shear);
        vstore3(min3(vload3(0, lo), vertex), 0, lo);
        vstore3(max3(vload3(0, hi), vertex), 0, hi);
        float edge = a.x * b.y - a.y * b.x;
        bool spans = SAHL_MIN(a.x, b.x) <= 0.0f && SAHL_MAX(a.x, b.x) >= 0.0f && SAHL_MIN(a.y, b.y) <= 0.0f &&
                     SAHL_MAX(a.y, b.y) >= 0.0f;
        on_outline = on_outline || (edge == 0.0f && spans);
        inside = inside != ((a.y > 0.0f) != (b.y > 0.0f) && (edge > 0.0f) == (b.y > a.y));
        a = b;
    }
    return inside || on_outline;
}

static inline void intersect_polygons(const global PolygonBlock* block, const global float* polygon_vertices,
                                      const Ray* ray, const RayShear* shear, const RayBoxTest* boxes,
                                      HitState* state, bool any_hit) {
    float4 nx = vload4(0, block->normal_x), ny = vload4(0, block->normal_y), nz = vload4(0, block->normal_z);
    float4 px = vload4(0, block->x) - ray->origin.x;
    float4 py = vload4(0, block->y) - ray->origin.y;
    float4 pz = vload4(0, block->z) - ray->origin.z;
    float4 nd = nx * ray->direction.x + ny * ray->direction.y + nz * ray->direction.z;
    float4 t = (nx * px + ny * py + nz * pz) / nd;
    // How far off t may be, by the rounding of the vertices' own coordinates too; NaN (a ray in the
    // plane) passes.
    float origin_sum = fabs(ray->origin.x) + fabs(ray->origin.y) + fabs(ray->origin.z);
    float4 doubt = 0x1p-20f * (fabs(px) + fabs(py) + fabs(pz) + origin_sum) / fabs(nd);
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
