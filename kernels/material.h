// Whitted's surface, SAHL_LANES places on one material: Phong or Blinn light, mirror directions, Snell's law.
#ifndef SAHL_MATERIAL_H
#define SAHL_MATERIAL_H

#include "kernels/device_types.h"
#include "kernels/lanes.h"
#include "kernels/light.h"
#include "kernels/power.h"

/// Light sent towards `wo` of what arrives from `wi` (both unit, away from the surface).
/// Phong (1975): (R·V)^n, gated by N·L > 0. Blinn (1977): (N·H)^n, ungated.
/// With interpolated normals a light can be above `ns` and below the surface; it is not cut off
/// here, the shadow ray decides (see Hanika 2021 for the terminator this leaves).
static inline floatv3 phong_light(const global DeviceMaterial* material, floatv3 diffuse, floatv3 specular,
                                  floatv3 ns, floatv3 wi, floatv3 wo) {
    floatv cosine = dotv(ns, wi);
    floatv3 light = mul(diffuse, SAHL_MAX(cosine, (floatv)(0.0f)));
    if (lane_bits(nonzerov(specular)) == 0u) {
        return light;
    }
    floatv lobe;
    if (material->flags & SAHL_MATERIAL_BLINN) {
        floatv3 h = add(wi, wo);
        floatv length2 = dotv(h, h);
        floatv base = dotv(ns, h) / sqrt(length2);
        lobe =
            where(length2 > 0.0f, power(SAHL_MAX(base, (floatv)(0.0f)), material->shininess), (floatv)(0.0f));
    } else {
        floatv3 r = sub(mul(ns, 2.0f * cosine), wi);
        floatv base = dotv(r, wo);
        lobe =
            where(cosine > 0.0f, power(SAHL_MAX(base, (floatv)(0.0f)), material->shininess), (floatv)(0.0f));
    }
    return add(light, mul(specular, lobe));
}

/// What remains of light that has come `distance` to this surface by reflection; infinite for the
/// background's.
static inline floatv reflection_falloff(const global DeviceMaterial* material, floatv distance) {
    const global float* a = material->attenuation;
    float of_background = a[1] == 0.0f && a[2] == 0.0f ? 1.0f / a[0] : 0.0f;
    return where(isinf(distance), (floatv)(of_background), 1.0f / attenuation(a, distance));
}

/// The mirror directions of unit `d` at unit normals `n` (either side).
static inline realv3 reflected_directions(realv3 d, realv3 n) {
    return normalizev(sub(d, mul(n, (real)2 * dotv(d, n))));
}

/// Snell's law: the directions of unit `d` behind surfaces with unit normals `n` against d; eta is
/// the index on d's side over the other's. Returns the lanes that are refracted, the others are reflected
/// totally.
static inline real_maskv refracted_directions(realv3 d, realv3 n, realv eta, realv3* refracted) {
    realv cosine = -dotv(d, n);
    realv k = (real)1 - eta * eta * ((real)1 - cosine * cosine);
    real_maskv passes = ~(k < (real)0);
    *refracted = where(passes, normalizev(add(mul(d, eta), mul(n, eta * cosine - sqrt(k)))), *refracted);
    return passes;
}

#endif
