// Procedural colours: patterns of the positions or of (u, v), SAHL_LANES places on one material.
#ifndef SAHL_TEXTURE_H
#define SAHL_TEXTURE_H

#include "kernels/device_types.h"
#include "kernels/real.h"
#include "kernels/surface.h"

/// The arctangent of z in [0, 1], relative error below 1e-7: by the half-angle to |z| <= tan(π/8), then
/// the power series. The library's is not the same on every device.
static inline float arctangent_unit(float z) {
    bool far = z > 0.41421356f;
    float x = far ? (z - 1.0f) / (z + 1.0f) : z;
    float x2 = x * x;
    float series =
        fma(x2,
            fma(x2,
                fma(x2, fma(x2, fma(x2, fma(x2, 1.0f / 13.0f, -1.0f / 11.0f), 1.0f / 9.0f), -1.0f / 7.0f),
                    1.0f / 5.0f),
                -1.0f / 3.0f),
            1.0f);
    return (far ? 0.785398163f : 0.0f) + x * series;
}

/// The angle from +x to (x, y) in whole turns, 0 to 1; 0 at the origin.
static inline float turn_of(float x, float y) {
    float ax = fabs(x), ay = fabs(y);
    float larger = SAHL_MAX(ax, ay), smaller = SAHL_MIN(ax, ay);
    float eighth = larger > 0.0f ? arctangent_unit(smaller / larger) * 0.159154943f : 0.0f;
    float quarter = ay > ax ? 0.25f - eighth : eighth;
    float half_turn = x < 0.0f ? 0.5f - quarter : quarter;
    return y < 0.0f ? 1.0f - half_turn : half_turn;
}

/// The two axes other than the one of box face `p`, 0 to 1.
static inline real3 box_uv(real3 p) {
    real3 a = fabs(p);
    real3 q = (p + (real)1) * (real)0.5;
    if (a.x >= a.y && a.x >= a.z) {
        return (real3)(q.y, q.z, 0);
    }
    return a.y >= a.z ? (real3)(q.x, q.z, 0) : (real3)(q.x, q.y, 0);
}

/// (u, v, 0) of a hit (engine/scene/scene.h says what they are).
static inline real3 surface_uv(const global DevicePrimitive* primitive, const global float* data, real3 p) {
    switch (primitive->kind) {
        case SAHL_KIND_TRIANGLE: {
            if (!(primitive->flags & SAHL_PRIMITIVE_UV)) {
                return p;
            }
            const global float* uv = data + (primitive->flags & SAHL_PRIMITIVE_SMOOTH ? 18 : 9);
            real w = (real)1 - p.x - p.y;
            return (real3)(w * uv[0] + p.x * uv[2] + p.y * uv[4], w * uv[1] + p.x * uv[3] + p.y * uv[5], 0);
        }
        case SAHL_KIND_POLYGON:
            return p;
        case SAHL_KIND_BOX:
            return box_uv(p);
        case SAHL_KIND_DISC:
            return (real3)(turn_of((float)p.x, (float)p.y), sqrt(p.x * p.x + p.y * p.y), 0);
        case SAHL_KIND_CONE:
        case SAHL_KIND_SOLID_CONE:
            return (real3)(turn_of((float)p.x, (float)p.y),
                           primitive->flags & SAHL_PRIMITIVE_TURNED ? (real)1 - p.z : p.z, 0);
        default:
            return (real3)(turn_of((float)p.x, (float)p.y),
                           (real)2 * turn_of((float)-p.z, (float)sqrt(p.x * p.x + p.y * p.y)), 0);
    }
}

static inline real_maskv is_odd(realv cell) { return cell - (real)2 * floor(cell * (real)0.5) != (real)0; }

static inline realv cells(realv x, real extent) { return extent != (real)0 ? floor(x / extent) : (realv)(0); }

static inline floatv3 texture_colors(const global DeviceTexture* texture, realv3 p) {
    floatv3 a = same3(load3(texture->color0)), b = same3(load3(texture->color1));
    real3 extent = load3_real(texture->extent);
    realv3 q = sub(p, same3_real(load3_real(texture->origin)));
    if (texture->pattern == SAHL_PATTERN_GRADIENT) {
        floatv x = convert_floatv(dotv(q, same3_real(extent)) / dot3_real(extent, extent));
        x = where(x > 0.0f, SAHL_MIN(x, (floatv)(1.0f)), (floatv)(0.0f));
        return add(mul(a, 1.0f - x), mul(b, x));
    }
    return where(convert_intv(is_odd(cells(q.x, extent.x) + cells(q.y, extent.y) + cells(q.z, extent.z))), b,
                 a);
}

/// (u, v, 0) of the lanes' hits; each by itself, as textures in these coordinates are few.
SAHL_NOINLINE realv3 surface_uvs(const Shapes* shapes, const Surfaces* surfaces, uintv primitive) {
    const uint* id = (const uint*)&primitive;
    const real *x = (const real*)&surfaces->shape.x, *y = (const real*)&surfaces->shape.y,
               *z = (const real*)&surfaces->shape.z;
    realv3 uv = same3_real((real3)(0));
    for (uint k = 0; k < SAHL_LANES; ++k) {
        const global DevicePrimitive* p = shapes->primitives + id[k];
        real3 of_lane = surface_uv(p, shapes->shape_data + p->data, (real3)(x[k], y[k], z[k]));
        ((real*)&uv.x)[k] = of_lane.x;
        ((real*)&uv.y)[k] = of_lane.y;
    }
    return uv;
}

/// A material's colours at the lanes' places.
typedef struct {
    floatv3 emitted;  // ambient light sent back, and emission
    floatv3 diffuse, specular, reflection;
} SurfaceColors;

/// color times a texture's colours there, if it has a texture.
static inline floatv3 textured(floatv3 color, const global DeviceTexture* textures, uint texture,
                               const Shapes* shapes, const Surfaces* surfaces, uintv primitive) {
    if (texture == SAHL_NO_TEXTURE) {
        return color;
    }
    SAHL_COUNT_LANES(shapes, texture_flop(textures + texture));
    const bool in_uv = textures[texture].space == SAHL_TEXTURE_UV;
    return mul(color, texture_colors(textures + texture,
                                     in_uv ? surface_uvs(shapes, surfaces, primitive) : surfaces->position));
}

/// `primitive`: of each lane one that exists.
static inline SurfaceColors surface_colors(const Shapes* shapes, const global DeviceMaterial* material,
                                           const global DeviceTexture* textures, const Surfaces* surfaces,
                                           uintv primitive) {
    floatv3 ambient = same3(load3(material->ambient)), emission = same3(load3(material->emission));
    SurfaceColors colors;
    colors.diffuse = same3(load3(material->diffuse));
    colors.specular = same3(load3(material->specular));
    colors.reflection = same3(load3(material->reflection));
    if (material->flags & SAHL_MATERIAL_TEXTURED) {
#define SAHL_TEXTURED(color, index) textured(color, textures, index, shapes, surfaces, primitive)
        ambient = SAHL_TEXTURED(ambient, material->ambient_texture);
        emission = SAHL_TEXTURED(emission, material->emission_texture);
        colors.diffuse = SAHL_TEXTURED(colors.diffuse, material->diffuse_texture);
        colors.specular = SAHL_TEXTURED(colors.specular, material->specular_texture);
        colors.reflection = SAHL_TEXTURED(colors.reflection, material->reflection_texture);
#undef SAHL_TEXTURED
    }
    colors.emitted = add(ambient, emission);
    return colors;
}

#endif
