// Watertight ray-triangle intersection, a group of rays against the triangles of a block, one after the
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
    floatg ax, ay, az, bx, by, bz, cx, cy, cz;
} ShearedTriangle;

/// keep_to_box() for rays of one octant.
static inline floatg keep_to_box_group(floatg t, const float* lo, const float* hi, const RayGroup* rays,
                                       uint octant) {
    floatg nearest, farthest;
#pragma unroll
    for (uint k = 0; k < 3u; ++k) {
        const bool backward = (octant >> k & 1u) != 0u;
        floatg enter =
            fma((floatg)(backward ? hi[k] : lo[k]), rays->inverse[k], rays->addend[k] - rays->slack[k]);
        floatg leave =
            fma((floatg)(backward ? lo[k] : hi[k]), rays->inverse[k], rays->addend[k] + rays->slack[k]);
        nearest = k == 0u ? enter : SAHL_MAX(nearest, enter);
        farthest = k == 0u ? leave : SAHL_MIN(farthest, leave);
    }
    t = t > nearest ? t : nearest;
    return t < farthest ? t : farthest;
}

/// Where rays of one octant meet the plane of triangle `lane`, kept to the triangle's box (keep_to_box());
/// *nd: the product of the plane's normal with their directions.
static inline floatg plane_distance(const global TriangleBlock* block, uint lane,
                                    const TrianglePlanes* planes, const RayGroup* rays, const PassAxes* pass,
                                    floatg* nd) {
    const float nx = ((const float*)&planes->normal[0])[lane];
    const float ny = ((const float*)&planes->normal[1])[lane];
    const float nz = ((const float*)&planes->normal[2])[lane];
    *nd = nx * rays->direction[0] + ny * rays->direction[1] + nz * rays->direction[2];
    floatg height;
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
    return keep_to_box_group(height / *nd, lo, hi, rays, pass->octant);
}

/// Triangle `lane` of the block for rays of one octant and shear, whose edges `s` are seen by the rays
/// `lanes`. `far`: where each ray's range ends, -inf for those that are not to be tested.
/// Returns whether a hit was taken.
static inline bool offer_triangle(const global TriangleBlock* block, uint lane, const TrianglePlanes* planes,
                                  const ShearedTriangle* s, floatg u, floatg v, floatg w, LaneMask lanes,
                                  const RayGroup* rays, const PassAxes* pass, floatg* far, GroupHits* hits,
                                  bool any_hit) {
    floatg nd;
    const floatg t = plane_distance(block, lane, planes, rays, pass, &nd);
    uint id = block->id[lane];
    int primitive = (int)(id & SAHL_ID_MASK);
    lanes &= lessg((floatg)(0.0f), t) & come_before(hits, *far, t, primitive, (int)pass->instance);
    if (!anyg(lanes)) {
        return false;
    }
    floatg determinant = (u + v) + w;
    lanes &= notg(equalg(determinant, (floatg)(0.0f)) | equalg((intg)(primitive), rays->exclude));
    // Not collinear triangles, which would be hit far along their line.
    lanes &= less_equalg((floatg)(0.0f), SAHL_MAX(SAHL_MAX(s->ax, s->bx), s->cx)) &
             less_equalg(SAHL_MIN(SAHL_MIN(s->ax, s->bx), s->cx), (floatg)(0.0f)) &
             less_equalg((floatg)(0.0f), SAHL_MAX(SAHL_MAX(s->ay, s->by), s->cy)) &
             less_equalg(SAHL_MIN(SAHL_MIN(s->ay, s->by), s->cy), (floatg)(0.0f));
    lanes &= seen_from_group(id, less_equalg(nd, (floatg)(0.0f)));
    if (!anyg(lanes)) {
        return false;
    }
    floatg scale = 1.0f / determinant;
    return take_hits(hits, far, lanes, t, v * scale, w * scale, id, pass->instance, any_hit);
}

/// The lanes for which the triangle may lie ahead of the origin (triangle.h).
static inline LaneMask not_behind(const global TriangleBlock* block, const ShearedTriangle* s, floatg u,
                                  floatg v, floatg w, const RayGroup* rays, const PassAxes* pass) {
    const floatg depth = fma(u, s->az, fma(v, s->bz, w * s->cz));
    const intg sign = (as_intg((u + v) + w) ^ as_intg(rays->inverse[pass->kz])) & (intg)((int)0x80000000);
    return less_equalg((floatg)(-block->depth_error[pass->kz]), as_floatg(as_intg(depth) ^ sign));
}

/// The rays (of one pass) against the block's triangles. Returns whether a hit was taken.
static inline bool intersect_triangles_group(const global TriangleBlock* block, LazyPlanes* planes,
                                             const float* shifted, const RayGroup* rays, const PassAxes* pass,
                                             floatg* far, GroupHits* hits, bool any_hit) {
    const global float* axes = (const global float*)block;
    const global float* x = axes + 16u * pass->kx;
    const global float* y = axes + 16u * pass->ky;
    const global float* z = axes + 16u * pass->kz;
    floatg ox = rays->origin[pass->kx], oy = rays->origin[pass->ky], oz = rays->origin[pass->kz];
    floatg sx = rays->shear_x, sy = rays->shear_y;
    // Those of other passes and those that are occluded need not be looked at. Most rays of a closest hit's
    // only pass are active, and the test costs more than it saves.
    const LaneMask active =
        any_hit || !pass->alone ? lessg((floatg)(0.0f), *far) : equalg((intg)(0), (intg)(0));
    bool taken = false;
    const uint count = (uint)block->count;
    for (uint lane = 0; lane < count; ++lane) {
        ShearedTriangle s;
        if (pass->common_origin) {
            const float* p = shifted + lane;
            s.az = (floatg)(p[32]);
            s.bz = (floatg)(p[36]);
            s.cz = (floatg)(p[40]);
            s.ax = fma(s.az, sx, (floatg)(p[0]));
            s.ay = fma(s.az, sy, (floatg)(p[16]));
            s.bx = fma(s.bz, sx, (floatg)(p[4]));
            s.by = fma(s.bz, sy, (floatg)(p[20]));
            s.cx = fma(s.cz, sx, (floatg)(p[8]));
            s.cy = fma(s.cz, sy, (floatg)(p[24]));
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
        floatg w = s.bx * s.ay - s.by * s.ax;
        floatg u = s.cx * s.by - s.cy * s.bx;
        floatg v = s.ax * s.cy - s.ay * s.cx;
        floatg least = SAHL_MIN(SAHL_MIN(u, v), w), greatest = SAHL_MAX(SAHL_MAX(u, v), w);
        LaneMask inside = less_equalg((floatg)(0.0f), least) | less_equalg(greatest, (floatg)(0.0f));
        inside &= active;
        // Not behind a branch of its own: which rays start on the triangle no processor can predict.
        if (any_hit || !pass->common_origin) {
            inside &= not_behind(block, &s, u, v, w, rays, pass);
        }
        if (anyg(inside)) {
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
