// Ray intersection with planar polygons, convex or concave, one ray against a block of four.
//
// The distance comes from the plane, kept to the vertices' own distances as for triangles. Inside or outside is decided by crossings of the sheared
// vertices (the shear of triangle.h) with the half-axis y = 0, x > 0; edge functions are computed
// as for triangles and edges of value 0 count as inside, so polygons that share edges with
// polygons or triangles leak nothing between them.
#ifndef SAHL_POLYGON_H
#define SAHL_POLYGON_H

#include "kernels/hit.h"
#include "kernels/simd.h"
#include "kernels/triangle.h"

/// A vertex in the ray's shear: x, y, and its distance along kz.
static inline float3 sheared_vertex(const global float* vertex, const RayShear* shear) {
    float z = vertex[shear->kz] - shear->oz;
    return (float3)(fma(z, shear->sx, vertex[shear->kx] - shear->ox), fma(z, shear->sy, vertex[shear->ky] - shear->oy),
                    z);
}

/// Whether the ray passes through the polygon or exactly through its outline; *z_low, *z_high: the
/// range of its vertices along kz.
static inline bool polygon_contains(const global float* vertices, uint count, const RayShear* shear, float* z_low,
                                    float* z_high) {
    bool inside = false, on_outline = false;
    float3 a = sheared_vertex(vertices + 3u * (count - 1u), shear);
    *z_low = a.z;
    *z_high = a.z;
    for (uint i = 0; i < count; ++i) {
        float3 b = sheared_vertex(vertices + 3u * i, shear);
        *z_low = SAHL_MIN(*z_low, b.z);
        *z_high = SAHL_MAX(*z_high, b.z);
        float edge = a.x * b.y - a.y * b.x;
        bool spans = SAHL_MIN(a.x, b.x) <= 0.0f && SAHL_MAX(a.x, b.x) >= 0.0f && SAHL_MIN(a.y, b.y) <= 0.0f &&
                     SAHL_MAX(a.y, b.y) >= 0.0f;
        on_outline = on_outline || (edge == 0.0f && spans);
        inside = inside != ((a.y > 0.0f) != (b.y > 0.0f) && (edge > 0.0f) == (b.y > a.y));
        a = b;
    }
    return inside || on_outline;
}

// A plane that the ray meets at a smaller cosine gives no distance to rely on.
#define SAHL_GRAZING_COSINE 0x1p-12f

static inline void intersect_polygons(const global PolygonBlock* block, const global float* polygon_vertices, const Ray* ray,
                               const RayShear* shear, HitState* state, bool any_hit) {
    float4 nx = vload4(0, block->normal_x), ny = vload4(0, block->normal_y), nz = vload4(0, block->normal_z);
    float4 px = vload4(0, block->x) - ray->origin.x;
    float4 py = vload4(0, block->y) - ray->origin.y;
    float4 pz = vload4(0, block->z) - ray->origin.z;
    float4 nd = nx * ray->direction.x + ny * ray->direction.y + nz * ray->direction.z;
    float4 t = (nx * px + ny * py + nz * pz) / nd;
    uint lanes = mask4(((t >= state->t_min) & (t <= state->t)) |
                       (fabs(nd) <= SAHL_GRAZING_COSINE * fabs(shear->dz)));
    while (lanes != 0u) {
        uint lane = lowest_lane(lanes);
        lanes &= lanes - 1u;
        uint id = block->id[lane];
        const global float* vertices = polygon_vertices + 3u * block->first_vertex[lane];
        float z_low, z_high;
        if ((id & SAHL_ID_MASK) != ray->exclude &&
            polygon_contains(vertices, block->vertex_count[lane], shear, &z_low, &z_high)) {
            float distance = keep_to_vertices(((float*)&t)[lane], z_low, z_high, shear->dz);
            offer_hit(state, distance, 0.0f, 0.0f, id, any_hit);
        }
    }
}

#endif
