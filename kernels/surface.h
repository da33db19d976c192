// From a hit to the surface there: position and normals.
#ifndef SAHL_SURFACE_H
#define SAHL_SURFACE_H

#include "kernels/device_types.h"
#include "kernels/instance.h"
#include "kernels/real.h"

/// What is known of all surfaces.
typedef struct {
    const global DevicePrimitive* primitives;
    const global float* shape_data;
    const global DeviceInstance* instances;
} Shapes;

typedef struct {
    real3 position;
    real3 ng;      // unit geometric normal, outward or by the winding
    real3 ns;      // unit shading normal, on ng's side
    real3 shape;   // place on the shape in its own space: triangle u, v; else as device_types.h says
    real t;        // of the ray
    float offset;  // how far off the surface along ng rays start
    uint material;
} Surface;

// Rays start this many times the largest coordinate of their position and primitive away: a few
// roundings of it, which single precision traversal needs.
#define SAHL_OFFSET_SCALE 0x1p-21f

/// Where a ray that leaves on `direction`'s side starts. Wächter and Binder 2019, "A Fast and
/// Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems, ch. 6), scale by the
/// position's own coordinates with a fixed floor near 0; here the primitive's coordinates set the
/// scale, as they bound the rounding error (Pharr, Jakob, Humphreys 2016, sec. 3.9), so that no
/// floor is needed and small scenes keep their proportions.
static inline float3 offset_origin(float3 position, float3 offset, float3 direction) {
    return dot3(offset, direction) < 0.0f ? position - offset : position + offset;
}

static inline real3 object_vector(const global float* m, real3 v) {
    return (real3)(dot3_real(load3_real(m), v), dot3_real(load3_real(m + 6), v),
                   dot3_real(load3_real(m + 12), v));
}

/// A normal of object space in the world: times the transpose of object-from-world.
static inline real3 world_normal(const global float* m, real3 n) {
    return normalize3_real(load3_real(m) * n.x + load3_real(m + 6) * n.y + load3_real(m + 12) * n.z);
}

/// The root of a x² + 2 b x + c next to 0; where rounding has made it complex, the vertex.
static inline real root_near_zero(real a, real b, real c) {
    real discriminant = b * b - a * c;
    return discriminant > (real)0 ? -c / (b + copysign(sqrt(discriminant), b)) : -b / a;
}

static inline Surface flat_surface(real3 origin, real3 direction, real3 normal, real3 anchor) {
    Surface s;
    s.t = dot3_real(normal, anchor - origin) / dot3_real(normal, direction);
    s.ng = normal;
    s.ns = normal;
    s.shape = (real3)(0);
    s.offset = max_abs3(round3(anchor));
    return s;
}

static inline Surface triangle_surface(const global float* data, bool smooth, real3 origin, real3 direction,
                                       float u, float v) {
    float3 a = load3(data), b = load3(data + 3), c = load3(data + 6);
    real3 v0 = convert_real3(a), v1 = convert_real3(b), v2 = convert_real3(c);
    Surface s = flat_surface(origin, direction, normalize3_real(cross3_real(v1 - v0, v2 - v0)), v0);
    if (smooth) {
        real3 n =
            convert_real3(load3(data + 9) * (1.0f - u - v) + load3(data + 12) * u + load3(data + 15) * v);
        real length2 = dot3_real(n, n);
        s.ns = length2 > (real)0 ? n / sqrt(length2) : s.ng;
    }
    s.shape = (real3)((real)u, (real)v, (real)0);
    s.offset = SAHL_MAX(SAHL_MAX(max_abs3(a), max_abs3(b)), max_abs3(c));
    return s;
}

static inline Surface polygon_surface(const global float* data, real3 origin, real3 direction) {
    real3 anchor = load3_real(data + 6);
    Surface s = flat_surface(origin, direction, load3_real(data), anchor);
    real3 from_anchor = origin + direction * s.t - anchor;
    s.shape = (real3)(dot3_real(load3_real(data + 14), from_anchor),
                      dot3_real(load3_real(data + 20), from_anchor), (real)0);
    return s;
}

static inline Surface sphere_surface(const global float* data, real3 origin, real3 direction, real t) {
    real3 center = load3_real(data);
    real radius = load_real(data + 6);
    real3 p = origin + direction * t - center;
    real step = root_near_zero(dot3_real(direction, direction), dot3_real(p, direction),
                               dot3_real(p, p) - radius * radius);
    p += direction * step;
    Surface s;
    s.t = t + step;
    s.ng = normalize3_real(p);
    s.ns = s.ng;
    s.shape = p / radius;
    s.offset = max_abs3(round3(center)) + (float)radius;
    return s;
}

/// A place on a shape of unit size: how far along the ray from the hit, and the normal there.
typedef struct {
    real step;
    real3 normal;
} ShapePoint;

/// Of the unit sphere, or of x² + y² = (1 + slope z)² for cones, what is nearest to p along d.
static inline ShapePoint quadric_point(real3 p, real3 d, bool cone, real slope) {
    real w = cone ? (real)1 + slope * p.z : (real)1, wd = cone ? slope * d.z : (real)0;
    real pz = cone ? (real)0 : p.z, dz = cone ? (real)0 : d.z;
    ShapePoint s;
    s.step =
        root_near_zero(d.x * d.x + d.y * d.y + dz * dz - wd * wd, p.x * d.x + p.y * d.y + pz * dz - w * wd,
                       p.x * p.x + p.y * p.y + pz * pz - w * w);
    p += d * s.step;
    s.normal = (real3)(p.x, p.y, cone ? -slope * ((real)1 + slope * p.z) : p.z);
    return s;
}

/// Of the plane n·x = offset; infinitely far when the ray runs along it.
static inline ShapePoint plane_point(real3 p, real3 d, real3 n, real offset) {
    real nd = dot3_real(n, d);
    ShapePoint s;
    s.step = nd != (real)0 ? (offset - dot3_real(n, p)) / nd : (real)INFINITY;
    s.normal = n;
    return s;
}

/// Of a solid cone near p, which is within rounding of its surface: on the cap where the ray meets
/// that within its outline and nearer than the side.
static inline ShapePoint solid_cone_point(real3 p, real3 d, real slope) {
    ShapePoint bottom = plane_point(p, d, (real3)(0, 0, -1), (real)0);
    ShapePoint top = plane_point(p, d, (real3)(0, 0, 1), (real)1);
    ShapePoint cap = fabs(bottom.step) < fabs(top.step) ? bottom : top;
    ShapePoint side = quadric_point(p, d, true, slope);
    real3 on_cap = p + d * cap.step;
    real w = (real)1 + slope * on_cap.z;
    bool within = on_cap.x * on_cap.x + on_cap.y * on_cap.y < w * w;
    bool cap_nearer = !(fabs(side.step) <= fabs(cap.step));
    return within && cap_nearer ? cap : side;
}

/// Of the box -1..1 near p, which is within rounding of its surface: the nearest face along the ray.
static inline ShapePoint box_point(real3 p, real3 d) {
    real3 side = (real3)(copysign((real)1, p.x), copysign((real)1, p.y), copysign((real)1, p.z));
    ShapePoint x = plane_point(p, d, (real3)(side.x, 0, 0), (real)1);
    ShapePoint y = plane_point(p, d, (real3)(0, side.y, 0), (real)1);
    ShapePoint z = plane_point(p, d, (real3)(0, 0, side.z), (real)1);
    ShapePoint nearest = fabs(y.step) < fabs(x.step) ? y : x;
    return fabs(z.step) < fabs(nearest.step) ? z : nearest;
}

/// Shapes with an object space of their own.
static inline Surface object_surface(uint kind, const global float* data, real3 origin, real3 direction,
                                     real t) {
    real3 center = load3_real(data + 18);
    real3 p = object_vector(data, origin + direction * t - center);
    real3 d = object_vector(data, direction);
    ShapePoint point;
    switch (kind) {
        case SAHL_KIND_DISC:
            point = plane_point(p, d, (real3)(0, 0, 1), (real)0);
            break;
        case SAHL_KIND_BOX:
            point = box_point(p, d);
            break;
        case SAHL_KIND_SOLID_CONE:
            point = solid_cone_point(p, d, load_real(data + 24));
            break;
        case SAHL_KIND_CONE:
            point = quadric_point(p, d, true, load_real(data + 24));
            break;
        default:
            point = quadric_point(p, d, false, (real)0);
            break;
    }
    Surface s;
    s.t = t + point.step;
    s.ng = world_normal(data, point.normal);
    s.ns = s.ng;
    s.shape = p + d * point.step;
    s.offset = max_abs3(round3(center));
    return s;
}

/// The surface of primitive `primitive` of `instance` where a ray hits it at about `t`; u, v:
/// barycentrics of a triangle.
static inline Surface surface_at(const Shapes* shapes, uint instance, uint primitive, real3 origin,
                                 real3 direction, float t, float u, float v) {
    const global DevicePrimitive* p = shapes->primitives + primitive;
    const global float* data = shapes->shape_data + p->data;
    const global DeviceInstance* placed = shapes->instances + (instance == SAHL_WORLD ? 0u : instance - 1u);
    real3 o = origin, d = direction;
    if (instance != SAHL_WORLD) {
        o = group_from_world_point(placed, origin);
        d = group_from_world_vector(placed, direction);
    }
    Surface s;
    switch (p->kind) {
        case SAHL_KIND_TRIANGLE:
            s = triangle_surface(data, (p->flags & SAHL_PRIMITIVE_SMOOTH) != 0u, o, d, u, v);
            break;
        case SAHL_KIND_POLYGON:
            s = polygon_surface(data, o, d);
            break;
        case SAHL_KIND_SPHERE:
            s = sphere_surface(data, o, d, (real)t);
            break;
        default:
            s = object_surface(p->kind, data, o, d, (real)t);
            break;
    }
    s.offset = SAHL_OFFSET_SCALE * SAHL_MAX(s.offset, max_abs3(round3(o + d * s.t)));
    s.position = origin + direction * s.t;
    s.material = p->material;
    if (instance != SAHL_WORLD) {
        // A step h along the world's normal takes h |n| along the group's: the same distance in roundings.
        real3 n = world_from_group_normal(placed, s.ng);
        real length = sqrt(dot3_real(n, n));
        s.ng = n / length;
        s.ns = normalize3_real(world_from_group_normal(placed, s.ns));
        s.offset =
            SAHL_MAX((float)((real)s.offset / length), SAHL_OFFSET_SCALE * max_abs3(round3(s.position)));
    }
    return s;
}

#endif
