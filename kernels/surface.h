// From a hit to the surface there: position and normals.
#ifndef SAHL_SURFACE_H
#define SAHL_SURFACE_H

#include "kernels/device_types.h"
#include "kernels/real.h"

typedef struct {
    real3 position;
    real3 ng;      // unit geometric normal, outward or by the winding
    real3 ns;      // unit shading normal, on ng's side
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
    return load3_real(m) * n.x + load3_real(m + 6) * n.y + load3_real(m + 12) * n.z;
}

/// The root of a x² + 2 b x + c next to 0; where rounding has made it complex, the vertex.
static inline real root_near_zero(real a, real b, real c) {
    real discriminant = b * b - a * c;
    return discriminant > (real)0 ? -c / (b + copysign(sqrt(discriminant), b)) : -b / a;
}

static inline Surface flat_surface(real3 origin, real3 direction, real3 normal, real3 anchor) {
    Surface s;
    s.position = origin + direction * (dot3_real(normal, anchor - origin) / dot3_real(normal, direction));
    s.ng = normal;
    s.ns = normal;
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
    s.offset = SAHL_MAX(SAHL_MAX(max_abs3(a), max_abs3(b)), max_abs3(c));
    return s;
}

/// The crossing nearest `hit` of the ray with the unit sphere of an object space, or with
/// x² + y² = (1 + slope z)² for cones. `p`, `d`: hit less the object's origin and direction there.
static inline Surface quadric_surface(real3 hit, real3 direction, const global float* m, real3 p, real3 d,
                                      bool cone, real slope) {
    real w = cone ? (real)1 + slope * p.z : (real)1, wd = cone ? slope * d.z : (real)0;
    real pz = cone ? (real)0 : p.z, dz = cone ? (real)0 : d.z;
    real step =
        root_near_zero(d.x * d.x + d.y * d.y + dz * dz - wd * wd, p.x * d.x + p.y * d.y + pz * dz - w * wd,
                       p.x * p.x + p.y * p.y + pz * pz - w * w);
    Surface s;
    s.position = hit + direction * step;
    p += d * step;
    real3 gradient = (real3)(p.x, p.y, cone ? -slope * ((real)1 + slope * p.z) : p.z);
    s.ng = normalize3_real(world_normal(m, gradient));
    s.ns = s.ng;
    return s;
}

static inline Surface sphere_surface(real3 hit, real3 direction, real3 center, real radius) {
    real3 p = hit - center;
    real step = root_near_zero(dot3_real(direction, direction), dot3_real(p, direction),
                               dot3_real(p, p) - radius * radius);
    Surface s;
    s.position = hit + direction * step;
    s.ng = normalize3_real(p + direction * step);
    s.ns = s.ng;
    s.offset = max_abs3(round3(center)) + (float)radius;
    return s;
}

/// The surface of primitive `primitive` where a ray hits it at about `t`; u, v: barycentrics of a
/// triangle.
static inline Surface surface_at(const global DevicePrimitive* primitives, const global float* shape_data,
                                 uint primitive, real3 origin, real3 direction, float t, float u, float v) {
    const global DevicePrimitive* p = primitives + primitive;
    const global float* data = shape_data + p->data;
    real3 hit = origin + direction * (real)t;
    Surface s;
    switch (p->kind) {
        case SAHL_KIND_TRIANGLE:
            s = triangle_surface(data, (p->flags & SAHL_PRIMITIVE_SMOOTH) != 0u, origin, direction, u, v);
            break;
        case SAHL_KIND_POLYGON:
            s = flat_surface(origin, direction, load3_real(data), load3_real(data + 6));
            break;
        case SAHL_KIND_SPHERE:
            s = sphere_surface(hit, direction, load3_real(data), load_real(data + 6));
            break;
        default: {
            real3 center = load3_real(data + 18);
            bool cone = p->kind == SAHL_KIND_CONE;
            s = quadric_surface(hit, direction, data, object_vector(data, hit - center),
                                object_vector(data, direction), cone, cone ? load_real(data + 24) : (real)0);
            s.offset = max_abs3(round3(center));
            break;
        }
    }
    s.offset = SAHL_OFFSET_SCALE * SAHL_MAX(s.offset, max_abs3(round3(s.position)));
    s.material = p->material;
    return s;
}

#endif
