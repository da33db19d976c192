// From a hit to the surface there: position, normals, and how far the position may be off.
#ifndef SAHL_SURFACE_H
#define SAHL_SURFACE_H

#include "kernels/device_types.h"
#include "kernels/math.h"

typedef struct {
    float3 position;
    float3 ng;  // unit geometric normal, outward or by the winding
    float3 ns;  // unit shading normal, on ng's side
    float3 offset;  // along ng: how far from it a ray must start to be off the surface
    uint material;
} Surface;

// A position computed in the surface's own equation is off by a few roundings of the largest
// coordinate that went into it; rays start this many times that coordinate away.
#define SAHL_OFFSET_SCALE 0x1p-18f

/// Where a ray that leaves on `direction`'s side starts. Wächter and Binder 2019, "A Fast and
/// Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems, ch. 6), scale by the
/// position's own coordinates with a fixed floor near 0; here the primitive's coordinates set the
/// scale, as they bound the rounding error (Pharr, Jakob, Humphreys 2016, sec. 3.9), so that no
/// floor is needed and small scenes keep their proportions.
static inline float3 offset_origin(float3 position, float3 offset, float3 direction) {
    return dot3(offset, direction) < 0.0f ? position - offset : position + offset;
}

static inline float3 object_point(const global float* m, float3 p) {
    return (float3)(dot3(load3(m), p), dot3(load3(m + 3), p), dot3(load3(m + 6), p));
}

/// A normal of object space in the world: times the transpose of object-from-world.
static inline float3 world_normal(const global float* m, float3 n) {
    return load3(m) * n.x + load3(m + 3) * n.y + load3(m + 6) * n.z;
}

static inline Surface triangle_surface(const global float* data, bool smooth, float u, float v) {
    Surface s;
    float3 v0 = load3(data), v1 = load3(data + 3), v2 = load3(data + 6);
    s.position = v0 * (1.0f - u - v) + v1 * u + v2 * v;
    s.ng = normalize3(accurate_cross3(v1 - v0, v2 - v0));
    s.ns = s.ng;
    if (smooth) {
        float3 n = load3(data + 9) * (1.0f - u - v) + load3(data + 12) * u + load3(data + 15) * v;
        float length2 = dot3(n, n);
        s.ns = length2 > 0.0f ? n / sqrt(length2) : s.ng;
    }
    float scale = SAHL_MAX(SAHL_MAX(max_abs3(v0), max_abs3(v1)), max_abs3(v2));
    s.offset = s.ng * (SAHL_OFFSET_SCALE * scale);
    return s;
}

/// One Newton step from `p` back to where f is 0, g its gradient; ng along g.
static inline Surface refined_surface(float3 p, float f, float3 g, float scale) {
    Surface s;
    float inverse_gg = 1.0f / dot3(g, g);
    s.position = p - g * (f * inverse_gg);
    s.ng = g * sqrt(inverse_gg);
    s.ns = s.ng;
    s.offset = s.ng * (SAHL_OFFSET_SCALE * SAHL_MAX(scale, max_abs3(p)));
    return s;
}

/// The surface of primitive `primitive` at a hit. `origin` and `direction` are the ray's.
static inline Surface surface_at(const global DevicePrimitive* primitives, const global float* shape_data, uint primitive,
                          float3 origin, float3 direction, float t, float u, float v) {
    const global DevicePrimitive* p = primitives + primitive;
    const global float* data = shape_data + p->data;
    float3 hit = origin + direction * t;
    Surface s;
    switch (p->kind) {
        case SAHL_KIND_TRIANGLE:
            s = triangle_surface(data, (p->flags & SAHL_PRIMITIVE_SMOOTH) != 0u, u, v);
            break;
        case SAHL_KIND_POLYGON: {
            float3 n = load3(data), anchor = load3(data + 3);
            s = refined_surface(hit, dot3(n, hit - anchor), n, max_abs3(anchor));
            break;
        }
        case SAHL_KIND_SPHERE: {
            float3 center = load3(data), out = hit - center;
            float radius = data[3], length = sqrt(dot3(out, out));
            s = refined_surface(hit, length - radius, out / length, max_abs3(center) + radius);
            break;
        }
        case SAHL_KIND_ELLIPSOID: {
            float3 center = load3(data + 9), q = object_point(data, hit - center);
            float length = sqrt(dot3(q, q));
            s = refined_surface(hit, length - 1.0f, world_normal(data, q / length), max_abs3(center));
            break;
        }
        default: {
            float3 base = load3(data + 9), q = object_point(data, hit - base);
            float slope = data[12], radius = sqrt(q.x * q.x + q.y * q.y);
            // At an apex there is no normal; any direction away from the axis will do.
            float3 outward = radius > 0.0f ? (float3)(q.x / radius, q.y / radius, -slope) : (float3)(1.0f, 0.0f, -slope);
            s = refined_surface(hit, radius - (1.0f + slope * q.z), world_normal(data, outward), max_abs3(base));
            break;
        }
    }
    s.material = p->material;
    return s;
}

#endif
