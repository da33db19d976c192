// Lights, seen from SAHL_LANES positions: which way they are and what arrives from them when nothing is in
// between.
#ifndef SAHL_LIGHT_H
#define SAHL_LIGHT_H

#include "kernels/device_types.h"
#include "kernels/lanes.h"

/// From positions to the light: a point light's or spot's distance is the vector's length, a
/// directional light's is infinite.
static inline floatv3 vectors_to_light(const global DeviceLight* light, floatv3 position) {
    floatv3 p = same3(load3(light->position));
    return light->kind == SAHL_LIGHT_DIRECTIONAL ? p : sub(p, position);
}

/// The largest t of a shadow ray along vector_to_light.
static inline float shadow_t_max(const global DeviceLight* light) {
    return light->kind == SAHL_LIGHT_DIRECTIONAL ? INFINITY : 1.0f;
}

/// The share of a spot's light that goes the way of unit `wi` reversed.
static inline floatv spot_falloff(const global DeviceLight* light, floatv3 wi) {
    floatv cosine = -dotv(wi, same3(load3(light->direction)));
    floatv x = (cosine - light->cos_outer) / (light->cos_inner - light->cos_outer);
    floatv between = where(cosine <= light->cos_outer, (floatv)(0.0f), x * x * (3.0f - 2.0f * x));
    return where(cosine >= light->cos_inner, (floatv)(1.0f), between);
}

/// What light is divided by after `distance`.
static inline floatv attenuation(const global float* a, floatv distance) {
    return a[0] + a[1] * distance + a[2] * distance * distance;
}

/// Colours of the light that arrives from unit directions `wi` and `distance`, unshadowed.
static inline floatv3 arriving_light(const global DeviceLight* light, floatv3 wi, floatv distance) {
    floatv3 color = same3(load3(light->color));
    if (light->kind == SAHL_LIGHT_DIRECTIONAL) {
        return color;
    }
    color = div(color, attenuation(light->attenuation, distance));
    return light->kind == SAHL_LIGHT_SPOT ? mul(color, spot_falloff(light, wi)) : color;
}

#endif
