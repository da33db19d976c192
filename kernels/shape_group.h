// Ray intersection with all that is no triangle, sixteen rays against the shapes of a block, one after the
// other. Where rays cross shapes is the arithmetic of crossings_of_width.h and polygon.h, as for one ray, so
// that hits are the same bits; here is which crossings are taken, as hit.h does it for one.
#ifndef SAHL_SHAPE_GROUP_H
#define SAHL_SHAPE_GROUP_H

#include "kernels/crossings.h"
#include "kernels/polygon.h"
#include "kernels/ray_group.h"
#include "kernels/triangle_group.h"

/// Who meets the shapes: rays, what their pass has in common, where their ranges end (-inf for those that are
/// not to be tested) and their hits.
typedef struct {
    const RayGroup* rays;
    const PassAxes* pass;
    float16* far;
    GroupHits* hits;
    bool any_hit;
} GroupTest;

/// Offers the rays `lanes` a crossing each with surface `id`. Returns whether a range has changed.
static inline bool offer_crossings(const GroupTest* test, Lanes16 lanes, float16 t, uint id) {
    lanes &= less16((float16)(0.0f), t) &
             come_before(test->hits, *test->far, t, (int)(id & SAHL_ID_MASK), (int)test->pass->instance);
    if (!any16(lanes)) {
        return false;
    }
    return take_hits(test->hits, test->far, lanes, t, (float16)(0.0f), (float16)(0.0f), id,
                     test->pass->instance, test->any_hit);
}

/// offer_roots() for sixteen rays.
static inline bool offer_roots16(const GroupTest* test, float16 enter, Lanes16 enter_valid, float16 leave,
                                 Lanes16 leave_valid, uint id) {
    Lanes16 starting = equal16((int16)((int)(id & SAHL_ID_MASK)), test->rays->exclude);
    if (any16(starting)) {
        Lanes16 enter_is_origin = less16(fabs(enter), fabs(leave));
        enter_valid &= not16(starting & enter_is_origin);
        leave_valid &= not16(starting) | enter_is_origin;
    }
    bool taken = is_seen_from(id, true) && offer_crossings(test, enter_valid, enter, id);
    return (is_seen_from(id, false) && offer_crossings(test, leave_valid, leave, id)) || taken;
}

/// The roots of a closed surface, NaN where a ray misses it.
static inline bool offer_chords16(const GroupTest* test, float16 enter, float16 leave, uint id) {
    Lanes16 lanes = less_equal16(enter, *test->far) & less_equal16((float16)(0.0f), leave);
    return any16(lanes) && offer_roots16(test, enter, lanes, leave, lanes, id);
}

/// The same by the middle of the rays' way inside.
static inline bool offer_chords_about(const GroupTest* test, Chords16 chords, uint id) {
    if (!any16(less_equal16((float16)(0.0f), chords.half_squared))) {
        return false;
    }
    float16 half_chord = sqrt(chords.half_squared);
    return offer_chords16(test, chords.middle - half_chord, chords.middle + half_chord, id);
}

static inline bool intersect_spheres16(const GroupTest* test, const global SphereBlock* block) {
    const float16* o = test->rays->origin;
    const float16* d = test->rays->direction;
    float16 inverse_dd = 1.0f / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    bool taken = false;
    // Unused lanes, whose radius is NaN, are the last ones.
    for (uint lane = 0; lane < SAHL_BLOCK_WIDTH && !isnan(block->radius[lane]); ++lane) {
        Chords16 chords = sphere_chords(block->x[lane] - o[0], block->y[lane] - o[1], block->z[lane] - o[2],
                                        (float16)(block->radius[lane]), d[0], d[1], d[2], inverse_dd);
        taken |= offer_chords_about(test, chords, block->id[lane]);
    }
    return taken;
}

static inline ObjectRays16 rays_about(const global QuadricBlock* block, uint lane, const RayGroup* rays,
                                      float middle_z) {
    float16 m[9];
#pragma unroll
    for (uint k = 0; k < 9u; ++k) {
        m[k] = (float16)(block->m[k][lane]);
    }
    const float16* o = rays->origin;
    const float16* d = rays->direction;
    return object_rays(m, o[0] - block->x[lane], o[1] - block->y[lane], o[2] - block->z[lane], d[0], d[1],
                       d[2], middle_z);
}

static inline bool intersect_cone16(const GroupTest* test, const ObjectRays16* r, float16 slope, uint id) {
    float16 enter, leave;
    int16 enter_valid, leave_valid;
    cross_cones(r, slope, &enter, &leave, &enter_valid, &leave_valid);
    return offer_roots16(test, enter, less16(enter_valid, (int16)(0)), leave, less16(leave_valid, (int16)(0)),
                         id);
}

static inline bool intersect_disc16(const GroupTest* test, const ObjectRays16* r, uint id) {
    int16 inside;
    float16 t = cross_discs(r, &inside);
    Lanes16 lanes =
        less16(inside, (int16)(0)) & not16(equal16((int16)((int)(id & SAHL_ID_MASK)), test->rays->exclude));
    lanes &= seen_from16(id, less16(r->dz, (float16)(0.0f)));
    return offer_crossings(test, lanes, t, id);
}

/// Any kind that has a QuadricBlock.
static inline bool intersect_quadrics16(const GroupTest* test, const global QuadricBlock* block, uint kind) {
    const bool is_cone = kind == SAHL_KIND_CONE || kind == SAHL_KIND_SOLID_CONE;
    bool taken = false;
    // Unused lanes, whose matrix is NaN, are the last ones.
    for (uint lane = 0; lane < SAHL_BLOCK_WIDTH && !isnan(block->m[0][lane]); ++lane) {
        const uint id = block->id[lane];
        const float16 slope = block->slope[lane];
        const ObjectRays16 r = rays_about(block, lane, test->rays, is_cone ? 0.5f : 0.0f);
        float16 enter, leave;
        switch (kind) {
            case SAHL_KIND_ELLIPSOID:
                taken |= offer_chords_about(test, ellipsoid_chords(&r), id);
                break;
            case SAHL_KIND_CONE:
                taken |= intersect_cone16(test, &r, slope, id);
                break;
            case SAHL_KIND_SOLID_CONE:
                cross_solid_cones(&r, slope, &enter, &leave);
                taken |= offer_chords16(test, enter, leave, id);
                break;
            case SAHL_KIND_DISC:
                taken |= intersect_disc16(test, &r, id);
                break;
            case SAHL_KIND_BOX:
                cross_boxes(&r, &enter, &leave);
                taken |= offer_chords16(test, enter, leave, id);
                break;
        }
    }
    return taken;
}

/// polygon_contains() for the rays of one pass.
static inline Lanes16 polygon_contains16(const global OutlineGroup* group, uint corner_count,
                                         const RayGroup* rays, const PassAxes* pass) {
    const float16 ox = rays->origin[pass->kx], oy = rays->origin[pass->ky], oz = rays->origin[pass->kz];
    int16 inside = 0, on_outline = 0;
    float16 ax = 0.0f, ay = 0.0f;
    for (uint first = 0; first < corner_count; first += SAHL_OUTLINE_EDGES, ++group) {
        const global float* axes = (const global float*)group;
        const uint edges = SAHL_MIN(corner_count - first, SAHL_OUTLINE_EDGES);
        for (uint i = first == 0u ? 0u : 1u; i <= edges; ++i) {
            const float16 z = axes[8u * pass->kz + i] - oz;
            const float16 bx = fma(z, rays->shear_x, axes[8u * pass->kx + i] - ox);
            const float16 by = fma(z, rays->shear_y, axes[8u * pass->ky + i] - oy);
            if (i > 0u) {
                cross_edge(ax, ay, bx, by, &inside, &on_outline);
            }
            ax = bx;
            ay = by;
        }
    }
    return not16(equal16(inside | on_outline, (int16)(0)));
}

static inline bool intersect_polygon16(const GroupTest* test, const global PolygonBlock* block,
                                       const global float* outlines) {
    const float16* o = test->rays->origin;
    const float16* d = test->rays->direction;
    const uint id = block->id;
    float16 nd, doubt;
    float16 t =
        cross_planes((float16)(block->normal[0]), (float16)(block->normal[1]), (float16)(block->normal[2]),
                     block->point[0] - o[0], block->point[1] - o[1], block->point[2] - o[2], d[0], d[1], d[2],
                     fabs(o[0]) + fabs(o[1]) + fabs(o[2]), &nd, &doubt);
    // NaN (a ray in the plane) passes.
    Lanes16 lanes = not16(less16(t, -doubt) | less16(*test->far + doubt, t));
    lanes &= less16((float16)(0.0f), *test->far);
    lanes &= seen_from16(id, less_equal16(nd, (float16)(0.0f)));
    lanes &= not16(equal16((int16)((int)(id & SAHL_ID_MASK)), test->rays->exclude));
    if (!any16(lanes)) {
        return false;
    }
    lanes &= polygon_contains16(outline_of(block, outlines), block->corner_count, test->rays, test->pass);
    float lo[3], hi[3];
    vstore3(load3(block->lo), 0, lo);
    vstore3(load3(block->hi), 0, hi);
    t = keep_to_box16(t, lo, hi, test->rays, test->pass->octant);
    return offer_crossings(test, lanes, t, id);
}

#endif
