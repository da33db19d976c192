// Where lines cross shapes: spheres, and in their object spaces (QuadricBlock) ellipsoids, cones and
// cylinders, open or solid, discs and boxes. All of it for vectors of SAHL_WIDTH floats whose lanes know
// nothing of each other: four shapes and one ray, or one shape and a group of rays, give the same bits.
// crossings.h includes this file once for each width; it has no include guard.
//
// The ray is first moved to the point nearest the shape (Haines, Günther, Akenine-Möller 2019,
// "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7), so that nothing
// cancels for a far or small one as B² - AC does. The cone's discriminant is then written as a sum of
// squares less a square, |w d - w' p|² - (p × d)² over x and y with w = 1 + slope z, in which the product
// p²d² of b² - ac is already gone; and the roots come from q = -(b ± s) so that neither is a difference
// of near numbers. Boxes are met by the slab method (Kay and Kajiya 1986).
#include "kernels/math.h"
#include "kernels/simd.h"

#ifndef SAHL_WIDTH
#define SAHL_WIDTH 4
#endif
#ifndef SAHL_OF_WIDTH
#define SAHL_JOINED(name, width) name##width
#define SAHL_OF_WIDTH(name, width) SAHL_JOINED(name, width)
#endif
#define Floats SAHL_OF_WIDTH(float, SAHL_WIDTH)
#define Ints SAHL_OF_WIDTH(int, SAHL_WIDTH)
#define as_ints SAHL_OF_WIDTH(as_int, SAHL_WIDTH)
#define ObjectRays SAHL_OF_WIDTH(ObjectRays, SAHL_WIDTH)
#define Chords SAHL_OF_WIDTH(Chords, SAHL_WIDTH)
#define ConeRoots SAHL_OF_WIDTH(ConeRoots, SAHL_WIDTH)

/// Rays in object spaces, from the points nearest the objects' middles; `shift` is how far along the
/// ray that is.
typedef struct {
    Floats px, py, pz;
    Floats dx, dy, dz;
    Floats inverse_dd;
    Floats shift;
} ObjectRays;

/// Parts of lines inside of convex shapes, about `middle`; half_squared is negative or NaN where there
/// is none.
typedef struct {
    Floats middle, half_squared;
} Chords;

/// Through spheres about c, seen from the rays' origins; inverse_dd = 1/(d·d).
SAHL_OVERLOAD Chords sphere_chords(Floats cx, Floats cy, Floats cz, Floats radius, Floats dx, Floats dy,
                                   Floats dz, Floats inverse_dd) {
    Chords chords;
    chords.middle = (cx * dx + cy * dy + cz * dz) * inverse_dd;
    Floats lx = cx - chords.middle * dx, ly = cy - chords.middle * dy, lz = cz - chords.middle * dz;
    chords.half_squared = (radius * radius - (lx * lx + ly * ly + lz * lz)) * inverse_dd;
    return chords;
}

/// Rays (o, d) seen from the objects' origins, in object space by the row-major m.
SAHL_OVERLOAD ObjectRays object_rays(const Floats* m, Floats ox, Floats oy, Floats oz, Floats dx, Floats dy,
                                     Floats dz, float middle_z) {
    ObjectRays r;
    Floats px = m[0] * ox + m[1] * oy + m[2] * oz;
    Floats py = m[3] * ox + m[4] * oy + m[5] * oz;
    Floats pz = m[6] * ox + m[7] * oy + m[8] * oz;
    r.dx = m[0] * dx + m[1] * dy + m[2] * dz;
    r.dy = m[3] * dx + m[4] * dy + m[5] * dz;
    r.dz = m[6] * dx + m[7] * dy + m[8] * dz;
    r.inverse_dd = 1.0f / (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    r.shift = -(px * r.dx + py * r.dy + (pz - middle_z) * r.dz) * r.inverse_dd;
    r.px = px + r.shift * r.dx;
    r.py = py + r.shift * r.dy;
    r.pz = pz + r.shift * r.dz;
    return r;
}

/// Through unit spheres.
SAHL_OVERLOAD Chords ellipsoid_chords(const ObjectRays* r) {
    Chords chords;
    chords.middle = r->shift;
    chords.half_squared = (1.0f - (r->px * r->px + r->py * r->py + r->pz * r->pz)) * r->inverse_dd;
    return chords;
}

/// Where x² + y² - (1 + slope z)² falls below 0 (`enter`) and rises above it (`leave`) along rays.
/// `growth` is its leading coefficient: where that is negative, leave < enter.
typedef struct {
    Floats enter, leave;
    Floats growth;
} ConeRoots;

SAHL_OVERLOAD ConeRoots cone_roots(const ObjectRays* r, Floats slope) {
    Floats w = 1.0f + slope * r->pz, wd = slope * r->dz;
    Floats ex = w * r->dx - wd * r->px, ey = w * r->dy - wd * r->py;
    Floats turn = r->px * r->dy - r->py * r->dx;
    Floats a = r->dx * r->dx + r->dy * r->dy - wd * wd;
    Floats discriminant = ex * ex + ey * ey - turn * turn;
    // A steep ray always has roots, however near it passes the apex.
    Floats s = sqrt(select(discriminant, SAHL_MAX(discriminant, 0.0f), a <= 0.0f));
    Floats b = r->px * r->dx + r->py * r->dy - w * wd;
    Floats radius = sqrt(r->px * r->px + r->py * r->py);
    Floats c = (radius - w) * (radius + w);
    Floats q = -(b + copysign(s, b));
    Floats first = q / a, second = c / q;
    // (-b - s)/a is the entering root, whatever the sign of a. `first` is that one where b has no
    // sign bit; select() looks at just that bit.
    ConeRoots roots;
    roots.enter = select(first, second, as_ints(b));
    roots.leave = select(second, first, as_ints(b));
    roots.growth = a;
    return roots;
}

/// Through open cones; *enter_valid, *leave_valid: whether that is where 0 <= z <= 1.
SAHL_OVERLOAD void cross_cones(const ObjectRays* r, Floats slope, Floats* enter, Floats* leave,
                               Ints* enter_valid, Ints* leave_valid) {
    ConeRoots roots = cone_roots(r, slope);
    Floats enter_z = r->pz + roots.enter * r->dz, leave_z = r->pz + roots.leave * r->dz;
    *enter_valid = (enter_z >= 0.0f) & (enter_z <= 1.0f);
    *leave_valid = (leave_z >= 0.0f) & (leave_z <= 1.0f);
    *enter = r->shift + roots.enter;
    *leave = r->shift + roots.leave;
}

/// Through the solids that cones and caps enclose: where rays are inside of both the cone and
/// 0 <= z <= 1, in one piece, so that nothing leaks where a cap meets the side. *enter is NaN where
/// there is nothing.
SAHL_OVERLOAD void cross_solid_cones(const ObjectRays* r, Floats slope, Floats* enter, Floats* leave) {
    Floats wd = slope * r->dz;
    ConeRoots roots = cone_roots(r, slope);
    // A ray steeper than the side is inside both halves of the double cone, in one of them before it
    // leaves and in the other from where it enters; the caps bound the half in which w = 1 + slope z
    // grows along the ray's way in or shrinks on its way out. Without such a root there is nothing.
    Ints steep = roots.growth <= 0.0f;
    Floats first = select(roots.enter, (Floats)(-INFINITY), steep & ~(wd > 0.0f));
    Floats last = select(roots.leave, (Floats)(INFINITY), steep & (wd > 0.0f));
    first = select(first, (Floats)(INFINITY), steep & (wd > 0.0f) & isinf(first));
    last = select(last, (Floats)(-INFINITY), steep & (wd < 0.0f) & isinf(last));
    // Along a cylinder's axis it is inside all the way or nowhere.
    Ints along = (wd == 0.0f) & (r->dx == 0.0f) & (r->dy == 0.0f);
    Floats beside = select((Floats)(INFINITY), (Floats)(-INFINITY), r->px * r->px + r->py * r->py <= 1.0f);
    first = select(first, beside, along);
    last = select(last, (Floats)(INFINITY), along);

    Floats inverse = finite_inverse(r->dz);
    Floats bottom = -r->pz * inverse, top = (1.0f - r->pz) * inverse;
    Floats inside = SAHL_MAX(first, SAHL_MIN(bottom, top));
    Floats outside = SAHL_MIN(last, SAHL_MAX(bottom, top));
    // The comparisons are false for NaN, which stands for a missed side.
    Ints hit = (inside <= outside) & (first <= last);
    *enter = select((Floats)(NAN), r->shift + inside, hit);
    *leave = r->shift + outside;
}

/// From a slab's middle to its planes along rays. A ray in parallel to them is between them all the
/// way or nowhere, in one of them too.
SAHL_OVERLOAD Floats slab_half(Floats p, Floats d, Floats inverse) {
    Floats parallel = select((Floats)(-INFINITY), (Floats)(INFINITY), fabs(p) <= 1.0f);
    return select(fabs(inverse), parallel, d == 0.0f);
}

/// Through boxes; *enter is NaN where rays miss them.
SAHL_OVERLOAD void cross_boxes(const ObjectRays* r, Floats* enter, Floats* leave) {
    Floats ix = finite_inverse(r->dx), iy = finite_inverse(r->dy), iz = finite_inverse(r->dz);
    // From the slab's middle to its planes and back.
    Floats x = -r->px * ix, y = -r->py * iy, z = -r->pz * iz;
    Floats half_x = slab_half(r->px, r->dx, ix), half_y = slab_half(r->py, r->dy, iy);
    Floats half_z = slab_half(r->pz, r->dz, iz);
    Floats inside = SAHL_MAX(SAHL_MAX(x - half_x, y - half_y), z - half_z);
    Floats outside = SAHL_MIN(SAHL_MIN(x + half_x, y + half_y), z + half_z);
    // NaN (unused lanes) is no hit.
    *enter = select((Floats)(NAN), r->shift + inside, inside <= outside);
    *leave = r->shift + outside;
}

/// Through the planes of discs; *inside: whether that is within the rim.
SAHL_OVERLOAD Floats cross_discs(const ObjectRays* r, Ints* inside) {
    Floats t = -r->pz / r->dz;
    Floats x = r->px + t * r->dx, y = r->py + t * r->dy;
    *inside = x * x + y * y <= 1.0f;
    return t + r->shift;
}

/// Through planes of unit normal n and a point p, seen from the rays' origins; *doubt: how far off that
/// may be, by the rounding of a polygon's vertices too; NaN where rays lie in the plane. *nd = n·d.
SAHL_OVERLOAD Floats cross_planes(Floats nx, Floats ny, Floats nz, Floats px, Floats py, Floats pz, Floats dx,
                                  Floats dy, Floats dz, Floats origin_sum, Floats* nd, Floats* doubt) {
    *nd = nx * dx + ny * dy + nz * dz;
    *doubt = 0x1p-20f * (fabs(px) + fabs(py) + fabs(pz) + origin_sum) / fabs(*nd);
    return (nx * px + ny * py + nz * pz) / *nd;
}

#undef Floats
#undef Ints
#undef as_ints
#undef ObjectRays
#undef Chords
#undef ConeRoots
