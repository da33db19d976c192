// Ray intersection with all that is no triangle, a group of rays against the shapes of a block, one after the
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
    floatg* far;
    GroupHits* hits;
    bool any_hit;
} GroupTest;

/// Offers the rays `lanes` a crossing each with surface `id`. Returns whether a range has changed.
static inline bool offer_crossings(const GroupTest* test, LaneMask lanes, floatg t, uint id) {
    lanes &= lessg((floatg)(0.0f), t) &
             come_before(test->hits, *test->far, t, (int)(id & SAHL_ID_MASK), (int)test->pass->instance);
    if (!anyg(lanes)) {
        return false;
    }
    return take_hits(test->hits, test->far, lanes, t, (floatg)(0.0f), (floatg)(0.0f), id,
                     test->pass->instance, test->any_hit);
}

/// offer_roots() for a group of rays.
static inline bool offer_roots_group(const GroupTest* test, floatg enter, LaneMask enter_valid, floatg leave,
                                     LaneMask leave_valid, uint id) {
    LaneMask starting = equalg((intg)((int)(id & SAHL_ID_MASK)), test->rays->exclude);
    if (anyg(starting)) {
        LaneMask enter_is_origin = lessg(fabs(enter), fabs(leave));
        enter_valid &= notg(starting & enter_is_origin);
        leave_valid &= notg(starting) | enter_is_origin;
    }
    bool taken = is_seen_from(id, true) && offer_crossings(test, enter_valid, enter, id);
    return (is_seen_from(id, false) && offer_crossings(test, leave_valid, leave, id)) || taken;
}

/// The roots of a closed surface, NaN where a ray misses it.
static inline bool offer_chords_group(const GroupTest* test, floatg enter, floatg leave, uint id) {
    LaneMask lanes = less_equalg(enter, *test->far) & less_equalg((floatg)(0.0f), leave);
    return anyg(lanes) && offer_roots_group(test, enter, lanes, leave, lanes, id);
}

/// The same by the middle of the rays' way inside.
static inline bool offer_chords_about(const GroupTest* test, Chordsg chords, uint id) {
    if (!anyg(less_equalg((floatg)(0.0f), chords.half_squared))) {
        return false;
    }
    floatg half_chord = sqrt(chords.half_squared);
    return offer_chords_group(test, chords.middle - half_chord, chords.middle + half_chord, id);
}

static inline bool intersect_spheres_group(const GroupTest* test, const global SphereBlock* block) {
    const floatg* o = test->rays->origin;
    const floatg* d = test->rays->direction;
    floatg inverse_dd = 1.0f / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    bool taken = false;
    // Unused lanes, whose radius is NaN, are the last ones.
    for (uint lane = 0; lane < SAHL_BLOCK_WIDTH && !isnan(block->radius[lane]); ++lane) {
        Chordsg chords = sphere_chords(block->x[lane] - o[0], block->y[lane] - o[1], block->z[lane] - o[2],
                                       (floatg)(block->radius[lane]), d[0], d[1], d[2], inverse_dd);
        taken |= offer_chords_about(test, chords, block->id[lane]);
    }
    return taken;
}

static inline ObjectRaysg rays_about(const global QuadricBlock* block, uint lane, const RayGroup* rays,
                                     float middle_z) {
    floatg m[9];
#pragma unroll
    for (uint k = 0; k < 9u; ++k) {
        m[k] = (floatg)(block->m[k][lane]);
    }
    const floatg* o = rays->origin;
    const floatg* d = rays->direction;
    return object_rays(m, o[0] - block->x[lane], o[1] - block->y[lane], o[2] - block->z[lane], d[0], d[1],
                       d[2], middle_z);
}

static inline bool intersect_cone_group(const GroupTest* test, const ObjectRaysg* r, floatg slope, uint id) {
    floatg enter, leave;
    intg enter_valid, leave_valid;
    cross_cones(r, slope, &enter, &leave, &enter_valid, &leave_valid);
    return offer_roots_group(test, enter, lessg(enter_valid, (intg)(0)), leave, lessg(leave_valid, (intg)(0)),
                             id);
}

static inline bool intersect_disc_group(const GroupTest* test, const ObjectRaysg* r, uint id) {
    intg inside;
    floatg t = cross_discs(r, &inside);
    LaneMask lanes =
        lessg(inside, (intg)(0)) & notg(equalg((intg)((int)(id & SAHL_ID_MASK)), test->rays->exclude));
    lanes &= seen_from_group(id, lessg(r->dz, (floatg)(0.0f)));
    return offer_crossings(test, lanes, t, id);
}

/// Any kind that has a QuadricBlock.
static inline bool intersect_quadrics_group(const GroupTest* test, const global QuadricBlock* block,
                                            uint kind) {
    const bool is_cone = kind == SAHL_KIND_CONE || kind == SAHL_KIND_SOLID_CONE;
    bool taken = false;
    // Unused lanes, whose matrix is NaN, are the last ones.
    for (uint lane = 0; lane < SAHL_BLOCK_WIDTH && !isnan(block->m[0][lane]); ++lane) {
        const uint id = block->id[lane];
        const floatg slope = block->slope[lane];
        const ObjectRaysg r = rays_about(block, lane, test->rays, is_cone ? 0.5f : 0.0f);
        floatg enter, leave;
        switch (kind) {
            case SAHL_KIND_ELLIPSOID:
                taken |= offer_chords_about(test, ellipsoid_chords(&r), id);
                break;
            case SAHL_KIND_CONE:
                taken |= intersect_cone_group(test, &r, slope, id);
                break;
            case SAHL_KIND_SOLID_CONE:
                cross_solid_cones(&r, slope, &enter, &leave);
                taken |= offer_chords_group(test, enter, leave, id);
                break;
            case SAHL_KIND_DISC:
                taken |= intersect_disc_group(test, &r, id);
                break;
            case SAHL_KIND_BOX:
                cross_boxes(&r, &enter, &leave);
                taken |= offer_chords_group(test, enter, leave, id);
                break;
        }
    }
    return taken;
}

/// polygon_contains() for the rays of one pass.
static inline LaneMask polygon_contains_group(const global OutlineGroup* group, uint corner_count,
                                              const RayGroup* rays, const PassAxes* pass) {
    const floatg ox = rays->origin[pass->kx], oy = rays->origin[pass->ky], oz = rays->origin[pass->kz];
    intg inside = 0, on_outline = 0;
    floatg ax = 0.0f, ay = 0.0f;
    for (uint first = 0; first < corner_count; first += SAHL_OUTLINE_EDGES, ++group) {
        const global float* axes = (const global float*)group;
        const uint edges = SAHL_MIN(corner_count - first, SAHL_OUTLINE_EDGES);
        for (uint i = first == 0u ? 0u : 1u; i <= edges; ++i) {
            const floatg z = axes[8u * pass->kz + i] - oz;
            const floatg bx = fma(z, rays->shear_x, axes[8u * pass->kx + i] - ox);
            const floatg by = fma(z, rays->shear_y, axes[8u * pass->ky + i] - oy);
            if (i > 0u) {
                cross_edge(ax, ay, bx, by, &inside, &on_outline);
            }
            ax = bx;
            ay = by;
        }
    }
    return notg(equalg(inside | on_outline, (intg)(0)));
}

static inline bool intersect_polygon_group(const GroupTest* test, const global PolygonBlock* block,
                                           const global float* outlines) {
    const floatg* o = test->rays->origin;
    const floatg* d = test->rays->direction;
    const uint id = block->id;
    floatg nd, doubt;
    floatg t =
        cross_planes((floatg)(block->normal[0]), (floatg)(block->normal[1]), (floatg)(block->normal[2]),
                     block->point[0] - o[0], block->point[1] - o[1], block->point[2] - o[2], d[0], d[1], d[2],
                     fabs(o[0]) + fabs(o[1]) + fabs(o[2]), &nd, &doubt);
    // NaN (a ray in the plane) passes.
    LaneMask lanes = notg(lessg(t, -doubt) | lessg(*test->far + doubt, t));
    lanes &= lessg((floatg)(0.0f), *test->far);
    lanes &= seen_from_group(id, less_equalg(nd, (floatg)(0.0f)));
    lanes &= notg(equalg((intg)((int)(id & SAHL_ID_MASK)), test->rays->exclude));
    if (!anyg(lanes)) {
        return false;
    }
    lanes &= polygon_contains_group(outline_of(block, outlines), block->corner_count, test->rays, test->pass);
    float lo[3], hi[3];
    vstore3(load3(block->lo), 0, lo);
    vstore3(load3(block->hi), 0, hi);
    t = keep_to_box_group(t, lo, hi, test->rays, test->pass->octant);
    return offer_crossings(test, lanes, t, id);
}

#endif
