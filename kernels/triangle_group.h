// Watertight ray-triangle intersection, sixteen rays against the triangles of a block, one after the
// other: the arithmetic of triangle.h, operation by operation, so that hits are the same bits.
#ifndef SAHL_TRIANGLE_GROUP_H
#define SAHL_TRIANGLE_GROUP_H

#include "kernels/ray_group.h"
#include "kernels/triangle.h"

/// What a pass of a packet has in common: the rays' octant and shear axes (triangle.h), the tree they
/// are in, and their origin if they share it.
typedef struct {
    uint octant;
    uint kx, ky, kz;
    uint instance;
    bool common_origin;
    bool alone;  // no other pass is left
    float origin[3];
} PassAxes;

/// TrianglePlanes of a block once the first ray has passed an edge test.
typedef struct {
    bool known;
    TrianglePlanes of;
} LazyPlanes;

/// Three vertices, x and y of them sheared.
typedef struct {
    float16 ax, ay, az, bx, by, bz, cx, cy, cz;
} ShearedTriangle;

/// keep_to_box() for rays of one octant.
static inline float16 keep_to_box16(float16 t, const float* lo, const float* hi, const RayGroup* rays,
                                    uint octant) {
    float16 nearest, farthest;
#pragma unroll
    for (uint k = 0; k < 3u; ++k) {
        const bool backward = (octant >> k & 1u) != 0u;
        float16 enter =
            fma((float16)(backward ? hi[k] : lo[k]), rays->inverse[k], rays->addend[k] - rays->slack[k]);
        float16 leave =
            fma((float16)(backward ? lo[k] : hi[k]), rays->inverse[k], rays->addend[k] + rays->slack[k]);
        nearest = k == 0u ? enter : SAHL_MAX(nearest, enter);
        farthest = k == 0u ? leave : SAHL_MIN(farthest, leave);
    }
    t = t > nearest ? t : nearest;
    return t < farthest ? t : farthest;
}

/// Where rays of one octant meet the plane of triangle `lane`, kept to the triangle's box (keep_to_box());
/// *nd: the product of the plane's normal with their directions.
static inline float16 plane_distance(const global TriangleBlock* block, uint lane,
                                     const TrianglePlanes* planes, const RayGroup* rays, const PassAxes* pass,
                                     float16* nd) {
    const float nx = ((const float*)&planes->normal[0])[lane];
    const float ny = ((const float*)&planes->normal[1])[lane];
    const float nz = ((const float*)&planes->normal[2])[lane];
    *nd = nx * rays->direction[0] + ny * rays->direction[1] + nz * rays->direction[2];
    float16 height;
    if (pass->common_origin) {
        height = nx * (block->x[lane] - pass->origin[0]) + ny * (block->y[lane] - pass->origin[1]) +
                 nz * (block->z[lane] - pass->origin[2]);
    } else {
        height = nx * (block->x[lane] - rays->origin[0]) + ny * (block->y[lane] - rays->origin[1]) +
                 nz * (block->z[lane] - rays->origin[2]);
    }
    float lo[3], hi[3];
    for (uint k = 0; k < 3u; ++k) {
        lo[k] = ((const float*)&planes->lo[k])[lane];
        hi[k] = ((const float*)&planes->hi[k])[lane];
    }
    return keep_to_box16(height / *nd, lo, hi, rays, pass->octant);
}

/// Triangle `lane` of the block for rays of one octant and shear, whose edges `s` are seen by the rays
/// `lanes`. `far`: where each ray's range ends, -inf for those that are not to be tested.
/// Returns whether a hit was taken.
static inline bool offer_triangle(const global TriangleBlock* block, uint lane, const TrianglePlanes* planes,
                                  const ShearedTriangle* s, float16 u, float16 v, float16 w, Lanes16 lanes,
                                  const RayGroup* rays, const PassAxes* pass, float16* far, GroupHits* hits,
                                  bool any_hit) {
    float16 nd;
    const float16 t = plane_distance(block, lane, planes, rays, pass, &nd);
    uint id = block->id[lane];
    int primitive = (int)(id & SAHL_ID_MASK);
    lanes &= less16((float16)(0.0f), t) & come_before(hits, *far, t, primitive, (int)pass->instance);
    if (!any16(lanes)) {
        return false;
    }
    float16 determinant = (u + v) + w;
    lanes &= not16(equal16(determinant, (float16)(0.0f)) | equal16((int16)(primitive), rays->exclude));
    // Not collinear triangles, which would be hit far along their line.
    lanes &= less_equal16((float16)(0.0f), SAHL_MAX(SAHL_MAX(s->ax, s->bx), s->cx)) &
             less_equal16(SAHL_MIN(SAHL_MIN(s->ax, s->bx), s->cx), (float16)(0.0f)) &
             less_equal16((float16)(0.0f), SAHL_MAX(SAHL_MAX(s->ay, s->by), s->cy)) &
             less_equal16(SAHL_MIN(SAHL_MIN(s->ay, s->by), s->cy), (float16)(0.0f));
    lanes &= seen_from16(id, less_equal16(nd, (float16)(0.0f)));
    if (!any16(lanes)) {
        return false;
    }
    float16 scale = 1.0f / determinant;
    return take_hits(hits, far, lanes, t, v * scale, w * scale, id, pass->instance, any_hit);
}

/// The lanes for which the triangle may lie ahead of the origin (triangle.h).
static inline Lanes16 not_behind(const global TriangleBlock* block, const ShearedTriangle* s, float16 u,
                                 float16 v, float16 w, const RayGroup* rays, const PassAxes* pass) {
    const float16 depth = fma(u, s->az, fma(v, s->bz, w * s->cz));
    const int16 sign = (as_int16((u + v) + w) ^ as_int16(rays->inverse[pass->kz])) & (int16)((int)0x80000000);
    return less_equal16((float16)(-block->depth_error[pass->kz]), as_float16(as_int16(depth) ^ sign));
}

/// The rays (of one pass) against the block's triangles. Returns whether a hit was taken.
static inline bool intersect_triangles16(const global TriangleBlock* block, LazyPlanes* planes,
                                         const float* shifted, const RayGroup* rays, const PassAxes* pass,
                                         float16* far, GroupHits* hits, bool any_hit) {
    const global float* axes = (const global float*)block;
    const global float* x = axes + 16u * pass->kx;
    const global float* y = axes + 16u * pass->ky;
    const global float* z = axes + 16u * pass->kz;
    float16 ox = rays->origin[pass->kx], oy = rays->origin[pass->ky], oz = rays->origin[pass->kz];
    float16 sx = rays->shear_x, sy = rays->shear_y;
    // Those of other passes and those that are occluded need not be looked at. Most rays of a closest hit's
    // only pass are active, and the test costs more than it saves.
    const Lanes16 active =
        any_hit || !pass->alone ? less16((float16)(0.0f), *far) : equal16((int16)(0), (int16)(0));
    bool taken = false;
    const uint count = (uint)block->count;
    for (uint lane = 0; lane < count; ++lane) {
        ShearedTriangle s;
        if (pass->common_origin) {
            const float* p = shifted + lane;
            s.az = (float16)(p[32]);
            s.bz = (float16)(p[36]);
            s.cz = (float16)(p[40]);
            s.ax = fma(s.az, sx, (float16)(p[0]));
            s.ay = fma(s.az, sy, (float16)(p[16]));
            s.bx = fma(s.bz, sx, (float16)(p[4]));
            s.by = fma(s.bz, sy, (float16)(p[20]));
            s.cx = fma(s.cz, sx, (float16)(p[8]));
            s.cy = fma(s.cz, sy, (float16)(p[24]));
        } else {
            s.az = z[lane] - oz;
            s.bz = z[4u + lane] - oz;
            s.cz = z[8u + lane] - oz;
            s.ax = fma(s.az, sx, x[lane] - ox);
            s.ay = fma(s.az, sy, y[lane] - oy);
            s.bx = fma(s.bz, sx, x[4u + lane] - ox);
            s.by = fma(s.bz, sy, y[4u + lane] - oy);
            s.cx = fma(s.cz, sx, x[8u + lane] - ox);
            s.cy = fma(s.cz, sy, y[8u + lane] - oy);
        }
        float16 w = s.bx * s.ay - s.by * s.ax;
        float16 u = s.cx * s.by - s.cy * s.bx;
        float16 v = s.ax * s.cy - s.ay * s.cx;
        float16 least = SAHL_MIN(SAHL_MIN(u, v), w), greatest = SAHL_MAX(SAHL_MAX(u, v), w);
        Lanes16 inside = less_equal16((float16)(0.0f), least) | less_equal16(greatest, (float16)(0.0f));
        inside &= active;
        if (any16(inside)) {
            if (any_hit) {
                inside &= not_behind(block, &s, u, v, w, rays, pass);
                if (!any16(inside)) {
                    continue;
                }
            }
            if (!planes->known) {
                planes->of = triangle_planes(block);
                planes->known = true;
            }
            taken |=
                offer_triangle(block, lane, &planes->of, &s, u, v, w, inside, rays, pass, far, hits, any_hit);
        }
    }
    return taken;
}

#endif
