// Whitted's surface: Phong or Blinn light, mirror direction, Snell's law.
#ifndef SAHL_MATERIAL_H
#define SAHL_MATERIAL_H

#include "kernels/device_types.h"
#include "kernels/light.h"
#include "kernels/real.h"

/// Light sent towards `wo` of what arrives from `wi` (both unit, away from the surface).
/// Phong (1975): (R·V)^n, gated by N·L > 0. Blinn (1977): (N·H)^n, ungated.
/// With interpolated normals a light can be above `ns` and below the surface; it is not cut off
/// here, the shadow ray decides (see Hanika 2021 for the terminator this leaves).
static inline float3 phong_light(const global DeviceMaterial* material, float3 diffuse, float3 specular,
                                 float3 ns, float3 wi, float3 wo) {
    float cosine = dot3(ns, wi);
    float3 light = diffuse * SAHL_MAX(cosine, 0.0f);
    if (!is_nonzero(specular)) {
        return light;
    }
    float lobe = 0.0f;
    if (material->flags & SAHL_MATERIAL_BLINN) {
        float3 h = wi + wo;
        float length2 = dot3(h, h);
        lobe =
            length2 > 0.0f ? power(SAHL_MAX(dot3(ns, h) / sqrt(length2), 0.0f), material->shininess) : 0.0f;
    } else if (cosine > 0.0f) {
        float3 r = ns * (2.0f * cosine) - wi;
        lobe = power(SAHL_MAX(dot3(r, wo), 0.0f), material->shininess);
    }
    return light + specular * lobe;
}

/// What remains of light that has come `distance` to this surface by reflection; infinite for the
/// background's.
static inline float reflection_falloff(const global DeviceMaterial* material, float distance) {
    const global float* a = material->attenuation;
    if (isinf(distance)) {
        return a[1] == 0.0f && a[2] == 0.0f ? 1.0f / a[0] : 0.0f;
    }
    return 1.0f / attenuation(a, distance);
}

/// The mirror direction of unit `d` at unit normal `n` (either side).
static inline real3 reflected_direction(real3 d, real3 n) {
    return normalize3_real(d - n * ((real)2 * dot3_real(d, n)));
}

/// Snell's law: the direction of unit `d` behind a surface with unit normal `n` against d; eta is
/// the index on d's side over the other's. False on total internal reflection.
static inline bool refracted_direction(real3 d, real3 n, real eta, real3* refracted) {
    real cosine = -dot3_real(d, n);
    real k = (real)1 - eta * eta * ((real)1 - cosine * cosine);
    if (k < (real)0) {
        return false;
    }
    *refracted = normalize3_real(d * eta + n * (eta * cosine - sqrt(k)));
    return true;
}

#endif
