// From hits to the surfaces there: positions and normals, of SAHL_LANES hits at a time.
//
// Neighbouring rays mostly hit shapes of the same kind. What each kind needs is computed for all lanes where
// any has it, from the data of each lane's own primitive; lanes of other kinds borrow a primitive of this
// one.
#ifndef SAHL_SURFACE_H
#define SAHL_SURFACE_H

#include "kernels/device_types.h"
#include "kernels/lanes.h"
#include "kernels/shade_flop.h"

/// What is known of all surfaces.
typedef struct {
    const global DevicePrimitive* primitives;
    const global float* shape_data;
    const global DeviceInstance* instances;
#ifdef SAHL_COUNT_VISITS
    global ulong* counts;  // of the work-item
#endif
} Shapes;

typedef struct {
    realv3 position;
    realv3 ng;      // unit geometric normals, outward or by the winding
    realv3 ns;      // unit shading normals, on ng's side
    realv3 shape;   // places on the shapes in their own spaces: triangle u, v; else as device_types.h says
    realv t;        // of the rays
    floatv offset;  // how far off the surface along ng rays start
    uintv material;
} Surfaces;

// Rays start this many times the largest coordinate of their position and primitive away: a few
// roundings of it, which single precision traversal needs.
#define SAHL_OFFSET_SCALE 0x1p-21f

/// Where rays that leave on `direction`'s side start. Wächter and Binder 2019, "A Fast and
/// Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems, ch. 6), scale by the
/// position's own coordinates with a fixed floor near 0; here the primitive's coordinates set the
/// scale, as they bound the rounding error (Pharr, Jakob, Humphreys 2016, sec. 3.9), so that no
/// floor is needed and small scenes keep their proportions.
static inline floatv3 offset_origins(floatv3 position, floatv3 offset, floatv3 direction) {
    return where(dotv(offset, direction) < 0.0f, sub(position, offset), add(position, offset));
}

/// Vectors in object space by the row-major matrices m.
static inline realv3 object_vectors(const floatv* m, realv3 v) {
    return (realv3){dotv(real_vectors_of(m), v), dotv(real_vectors_of(m + 6), v),
                    dotv(real_vectors_of(m + 12), v)};
}

/// Normals of object space in the world: times the transpose of object-from-world.
static inline realv3 world_normals(const floatv* m, realv3 n) {
    return normalizev(add(add(mul(real_vectors_of(m), n.x), mul(real_vectors_of(m + 6), n.y)),
                          mul(real_vectors_of(m + 12), n.z)));
}

/// The roots of a x² + 2 b x + c next to 0; where rounding has made them complex, the vertex.
static inline realv roots_near_zero(realv a, realv b, realv c) {
    realv discriminant = b * b - a * c;
    return where(discriminant > (real)0, -c / (b + copysign(sqrt(discriminant), b)), -b / a);
}

static inline Surfaces flat_surfaces(realv3 origin, realv3 direction, realv3 normal, realv3 anchor) {
    Surfaces s;
    s.t = dotv(normal, sub(anchor, origin)) / dotv(normal, direction);
    s.ng = normal;
    s.ns = normal;
    s.shape = same3_real((real3)(0));
    s.offset = max_absv(roundv(anchor));
    return s;
}

/// Of triangles at `data`; those of the lanes `smooth` have normals behind their vertices, at `normals`.
static inline Surfaces triangle_surfaces(const LanePlaces* data, const LanePlaces* normals, intv smooth,
                                         realv3 origin, realv3 direction, floatv u, floatv v) {
    floatv corners[9];
    gather8(data, 0, corners);
    corners[8] = gather(data, 8);
    floatv3 a = vectors_of(corners), b = vectors_of(corners + 3), c = vectors_of(corners + 6);
    realv3 v0 = widen(a), v1 = widen(b), v2 = widen(c);
    Surfaces s = flat_surfaces(origin, direction, normalizev(crossv(sub(v1, v0), sub(v2, v0))), v0);
    if (lane_bits(smooth) != 0u) {
        floatv at_corners[9];
        gather8(normals, 0, at_corners);
        at_corners[8] = gather(normals, 8);
        floatv3 sum = add(mul(vectors_of(at_corners), 1.0f - u - v), mul(vectors_of(at_corners + 3), u));
        realv3 n = widen(add(sum, mul(vectors_of(at_corners + 6), v)));
        realv length2 = dotv(n, n);
        s.ns = where(smooth, where(length2 > (real)0, div(n, sqrt(length2)), s.ng), s.ns);
    }
    s.shape = (realv3){convert_realv(u), convert_realv(v), (realv)(0)};
    floatv of_a = max_absv(a), of_b = max_absv(b), of_c = max_absv(c);
    floatv larger = SAHL_MAX(of_a, of_b);
    s.offset = SAHL_MAX(larger, of_c);
    return s;
}

static inline Surfaces polygon_surfaces(const LanePlaces* data, realv3 origin, realv3 direction) {
    floatv numbers[26];
    gather8(data, 0, numbers);
    gather8(data, 8, numbers + 8);
    gather8(data, 16, numbers + 16);
    numbers[24] = gather(data, 24);
    numbers[25] = gather(data, 25);
    realv3 anchor = real_vectors_of(numbers + 6);
    Surfaces s = flat_surfaces(origin, direction, real_vectors_of(numbers), anchor);
    realv3 from_anchor = sub(add(origin, mul(direction, s.t)), anchor);
    s.shape = (realv3){dotv(real_vectors_of(numbers + 14), from_anchor),
                       dotv(real_vectors_of(numbers + 20), from_anchor), (realv)(0)};
    return s;
}

static inline Surfaces sphere_surfaces(const LanePlaces* data, realv3 origin, realv3 direction, realv t) {
    floatv numbers[8];
    gather8(data, 0, numbers);
    realv3 center = real_vectors_of(numbers);
    realv radius = reals_of(numbers + 6);
    realv3 p = sub(add(origin, mul(direction, t)), center);
    realv step =
        roots_near_zero(dotv(direction, direction), dotv(p, direction), dotv(p, p) - radius * radius);
    p = add(p, mul(direction, step));
    Surfaces s;
    s.t = t + step;
    s.ng = normalizev(p);
    s.ns = s.ng;
    s.shape = div(p, radius);
    s.offset = max_absv(roundv(center)) + convert_floatv(radius);
    return s;
}

/// Places on shapes of unit size: how far along the rays from the hits, and the normals there.
typedef struct {
    realv step;
    realv3 normal;
} ShapePoints;

static inline ShapePoints where_points(real_maskv mask, ShapePoints a, ShapePoints b) {
    return (ShapePoints){where(mask, a.step, b.step), where(mask, a.normal, b.normal)};
}

/// Of unit spheres, what is nearest to p along d.
static inline ShapePoints ellipsoid_points(realv3 p, realv3 d) {
    ShapePoints s;
    s.step = roots_near_zero(dotv(d, d), dotv(p, d), dotv(p, p) - (real)1);
    s.normal = add(p, mul(d, s.step));
    return s;
}

/// Of x² + y² = (1 + slope z)², what is nearest to p along d.
static inline ShapePoints cone_points(realv3 p, realv3 d, realv slope) {
    realv w = (real)1 + slope * p.z, wd = slope * d.z;
    ShapePoints s;
    s.step = roots_near_zero(d.x * d.x + d.y * d.y - wd * wd, p.x * d.x + p.y * d.y - w * wd,
                             p.x * p.x + p.y * p.y - w * w);
    p = add(p, mul(d, s.step));
    s.normal = (realv3){p.x, p.y, -slope * ((real)1 + slope * p.z)};
    return s;
}

/// Of planes n·x = offset; infinitely far where the ray runs along it.
static inline ShapePoints plane_points(realv3 p, realv3 d, realv3 n, real offset) {
    realv nd = dotv(n, d);
    ShapePoints s;
    s.step = where(nd != (real)0, ((realv)(offset)-dotv(n, p)) / nd, (realv)(INFINITY));
    s.normal = n;
    return s;
}

/// Of solid cones near p, which is within rounding of their surface: on the cap where the ray meets
/// that within its outline and nearer than the side.
static inline ShapePoints solid_cone_points(realv3 p, realv3 d, realv slope) {
    ShapePoints bottom = plane_points(p, d, same3_real((real3)(0, 0, -1)), (real)0);
    ShapePoints top = plane_points(p, d, same3_real((real3)(0, 0, 1)), (real)1);
    ShapePoints cap = where_points(fabs(bottom.step) < fabs(top.step), bottom, top);
    ShapePoints side = cone_points(p, d, slope);
    realv3 on_cap = add(p, mul(d, cap.step));
    realv w = (real)1 + slope * on_cap.z;
    real_maskv within = on_cap.x * on_cap.x + on_cap.y * on_cap.y < w * w;
    real_maskv cap_nearer = ~(fabs(side.step) <= fabs(cap.step));
    return where_points(within & cap_nearer, cap, side);
}

/// Of boxes -1..1 near p, which is within rounding of their surface: the nearest face along the ray.
static inline ShapePoints box_points(realv3 p, realv3 d) {
    const realv one = (realv)(1), none = (realv)(0);
    ShapePoints x = plane_points(p, d, (realv3){copysign(one, p.x), none, none}, (real)1);
    ShapePoints y = plane_points(p, d, (realv3){none, copysign(one, p.y), none}, (real)1);
    ShapePoints z = plane_points(p, d, (realv3){none, none, copysign(one, p.z)}, (real)1);
    ShapePoints nearest = where_points(fabs(y.step) < fabs(x.step), y, x);
    return where_points(fabs(z.step) < fabs(nearest.step), z, nearest);
}

/// A bit for each kind that lanes have.
static inline uint kinds_present(uintv kind) {
    return 1u << kind.s0 | 1u << kind.s1 | 1u << kind.s2 | 1u << kind.s3 | 1u << kind.s4 | 1u << kind.s5 |
           1u << kind.s6 | 1u << kind.s7;
}

/// Of shapes with an object space of their own. `slopes`: where lanes have theirs, if they have one.
static inline Surfaces object_surfaces(uintv kind, uint present, const LanePlaces* data,
                                       const LanePlaces* slopes, realv3 origin, realv3 direction, realv t) {
    floatv numbers[24];
    gather8(data, 0, numbers);
    gather8(data, 8, numbers + 8);
    gather8(data, 16, numbers + 16);
    realv3 center = real_vectors_of(numbers + 18);
    realv3 p = object_vectors(numbers, sub(add(origin, mul(direction, t)), center));
    realv3 d = object_vectors(numbers, direction);
    realv slope = (realv)(0);
    if (present & (1u << SAHL_KIND_CONE | 1u << SAHL_KIND_SOLID_CONE)) {
        const floatv slope_numbers[2] = {gather(slopes, 0), gather(slopes, 1)};
        slope = reals_of(slope_numbers);
    }
    ShapePoints points = ellipsoid_points(p, d);
    if (present & 1u << SAHL_KIND_DISC) {
        points = where_points(convert_real_maskv(kind == SAHL_KIND_DISC),
                              plane_points(p, d, same3_real((real3)(0, 0, 1)), (real)0), points);
    }
    if (present & 1u << SAHL_KIND_BOX) {
        points = where_points(convert_real_maskv(kind == SAHL_KIND_BOX), box_points(p, d), points);
    }
    if (present & 1u << SAHL_KIND_SOLID_CONE) {
        points = where_points(convert_real_maskv(kind == SAHL_KIND_SOLID_CONE),
                              solid_cone_points(p, d, slope), points);
    }
    if (present & 1u << SAHL_KIND_CONE) {
        points = where_points(convert_real_maskv(kind == SAHL_KIND_CONE), cone_points(p, d, slope), points);
    }
    Surfaces s;
    s.t = t + points.step;
    s.ng = world_normals(numbers, points.normal);
    s.ns = s.ng;
    s.shape = add(p, mul(d, points.step));
    s.offset = max_absv(roundv(center));
    return s;
}

static inline Surfaces where_surfaces(intv mask, Surfaces a, Surfaces b) {
    Surfaces s;
    s.ng = where(mask, a.ng, b.ng);
    s.ns = where(mask, a.ns, b.ns);
    s.shape = where(mask, a.shape, b.shape);
    s.t = where(mask, a.t, b.t);
    s.offset = where(mask, a.offset, b.offset);
    return s;
}

/// Instances' object_from_world.
typedef struct {
    realv3 rows[3];
    realv3 translation;
} Placements;

/// Of the DeviceInstances at `at`.
static inline Placements placements(const LanePlaces* at) {
    Placements placed;
    realv shift[3];
#pragma unroll
    for (uint row = 0; row < 3u; ++row) {
        floatv numbers[8];
        gather8(at, 8u * row, numbers);
        placed.rows[row] = add(widen(vectors_of(numbers)), widen(vectors_of(numbers + 4)));
        shift[row] = convert_realv(numbers[3]) + convert_realv(numbers[7]);
    }
    placed.translation = (realv3){shift[0], shift[1], shift[2]};
    return placed;
}

static inline realv3 group_from_world_vectors(const Placements* placed, realv3 v) {
    return (realv3){dotv(placed->rows[0], v), dotv(placed->rows[1], v), dotv(placed->rows[2], v)};
}

static inline realv3 group_from_world_points(const Placements* placed, realv3 p) {
    return add(group_from_world_vectors(placed, p), placed->translation);
}

/// Normals of the groups in the world, of any length: times the transpose of object_from_world.
static inline realv3 world_from_group_normals(const Placements* placed, realv3 n) {
    return add(add(mul(placed->rows[0], n.x), mul(placed->rows[1], n.y)), mul(placed->rows[2], n.z));
}

/// The lanes' own values where `mask` holds, elsewhere that of the first lane where it does.
static inline uintv borrowed(intv mask, uintv value) {
    return mask ? value : (uintv)(((const uint*)&value)[lowest_lane(lane_bits(mask))]);
}

/// DevicePrimitives of the lanes.
typedef struct {
    uintv kind, material, data, flags;
} PrimitiveLanes;

/// As words, in the order of DevicePrimitive.
static inline PrimitiveLanes load_primitives(const global DevicePrimitive* primitives, uintv id) {
    floatv words[4];
#pragma unroll
    for (uint lane = 0; lane < 4u; ++lane) {
        const global float* low = (const global float*)(primitives + ((const uint*)&id)[lane]);
        const global float* high = (const global float*)(primitives + ((const uint*)&id)[lane + 4u]);
        words[lane] = (float8)(vload4(0, low), vload4(0, high));
    }
    transpose4(words);
    return (PrimitiveLanes){as_uintv(words[0]), as_uintv(words[1]), as_uintv(words[2]), as_uintv(words[3])};
}

/// Adds the surfaces of the lanes `these`; `*missing`: those of which there is none yet.
static inline void add_surfaces(Surfaces* s, intv these, Surfaces of_these, intv* missing) {
    // Mostly neighbours hit the same kind.
    *s = lane_bits(~*missing) == 0u ? of_these : where_surfaces(these, of_these, *s);
    *missing &= ~these;
}

/// surfaces_at() in the space of the primitives, without the position.
SAHL_NOINLINE void surfaces_of_kinds(const Shapes* shapes, uintv primitive, const realv3* origin,
                                     const realv3* direction, const floatv3* place, Surfaces* s) {
    const PrimitiveLanes of = load_primitives(shapes->primitives, primitive);
    const uintv kind = of.kind, data = of.data;
    const uint present = kinds_present(kind);
    const realv t = convert_realv(place->x);
    intv missing = (intv)(-1);
    if (present & 1u << SAHL_KIND_TRIANGLE) {
        const intv these = kind == SAHL_KIND_TRIANGLE;
        const intv smooth = these & ((of.flags & SAHL_PRIMITIVE_SMOOTH) != 0u);
        const uintv at = borrowed(these, data);
        const LanePlaces vertices = places(shapes->shape_data, at);
        const LanePlaces normals = places(shapes->shape_data, smooth ? at + 9u : at);
        SAHL_COUNT_LANES(shapes, lane_bits(smooth) != 0u ? SAHL_SMOOTH_FLOP : 0u);
        add_surfaces(s, these,
                     triangle_surfaces(&vertices, &normals, smooth, *origin, *direction, place->y, place->z),
                     &missing);
    }
    if (present & 1u << SAHL_KIND_POLYGON) {
        const intv these = kind == SAHL_KIND_POLYGON;
        const LanePlaces at = places(shapes->shape_data, borrowed(these, data));
        add_surfaces(s, these, polygon_surfaces(&at, *origin, *direction), &missing);
    }
    if (present & 1u << SAHL_KIND_SPHERE) {
        const intv these = kind == SAHL_KIND_SPHERE;
        const LanePlaces at = places(shapes->shape_data, borrowed(these, data));
        add_surfaces(s, these, sphere_surfaces(&at, *origin, *direction, t), &missing);
    }
    if (lane_bits(missing) != 0u) {
        const uintv offset = borrowed(missing, data);
        const intv sloped = (kind == SAHL_KIND_CONE) | (kind == SAHL_KIND_SOLID_CONE);
        const LanePlaces at = places(shapes->shape_data, offset);
        const LanePlaces slopes = places(shapes->shape_data, sloped ? offset + 24u : offset);
        add_surfaces(s, missing, object_surfaces(kind, present, &at, &slopes, *origin, *direction, t),
                     &missing);
    }
    SAHL_COUNT_LANES(shapes, surface_flop(present));
    s->material = of.material;
}

/// The surfaces of `primitive` of `instance` where rays hit them; `place`: about t, and u, v, the
/// barycentrics of triangles. Of the lanes `hit`, of which there is one at least.
static inline Surfaces surfaces_at(const Shapes* shapes, intv hit, uintv instance, uintv primitive,
                                   const realv3* origin, const realv3* direction, const floatv3* place) {
    const intv placed = hit & (instance != SAHL_WORLD);
    const realv3 *o = origin, *d = direction;
    realv3 placed_origin, placed_direction;
    Placements rows;
    if (lane_bits(placed) != 0u) {
        const LanePlaces at =
            places((const global float*)shapes->instances,
                   (borrowed(placed, instance) - 1u) * (uint)(sizeof(DeviceInstance) / sizeof(float)));
        rows = placements(&at);
        SAHL_COUNT_LANES(shapes, SAHL_PLACED_FLOP);
        placed_origin = where(placed, group_from_world_points(&rows, *origin), *origin);
        placed_direction = where(placed, group_from_world_vectors(&rows, *direction), *direction);
        o = &placed_origin;
        d = &placed_direction;
    }
    Surfaces s;
    surfaces_of_kinds(shapes, borrowed(hit, primitive), o, d, place, &s);
    floatv of_hit = max_absv(roundv(add(*o, mul(*d, s.t))));
    s.offset = SAHL_OFFSET_SCALE * SAHL_MAX(s.offset, of_hit);
    s.position = add(*origin, mul(*direction, s.t));
    if (lane_bits(placed) != 0u) {
        // A step h along the world's normal takes h |n| along the group's: the same distance in roundings.
        realv3 n = world_from_group_normals(&rows, s.ng);
        realv length = sqrt(dotv(n, n));
        s.ng = where(placed, div(n, length), s.ng);
        s.ns = where(placed, normalizev(world_from_group_normals(&rows, s.ns)), s.ns);
        floatv of_position = SAHL_OFFSET_SCALE * max_absv(roundv(s.position));
        floatv of_group = convert_floatv(convert_realv(s.offset) / length);
        s.offset = where(placed, SAHL_MAX(of_group, of_position), s.offset);
    }
    return s;
}

#endif
