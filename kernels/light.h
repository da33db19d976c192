// Lights: which way they are and what arrives from them when nothing is in between.
#ifndef SAHL_LIGHT_H
#define SAHL_LIGHT_H

#include "kernels/device_types.h"
#include "kernels/math.h"

/// From `position` to the light: a point light's or spot's distance is the vector's length, a
/// directional light's is infinite.
static inline float3 vector_to_light(const global DeviceLight* light, float3 position) {
    float3 p = load3(light->position);
    return light->kind == SAHL_LIGHT_DIRECTIONAL ? p : p - position;
}

/// The largest t of a shadow ray along vector_to_light.
static inline float shadow_t_max(const global DeviceLight* light) {
    return light->kind == SAHL_LIGHT_DIRECTIONAL ? INFINITY : 1.0f;
}

/// The share of a spot's light that goes the way of unit `wi` reversed.
static inline float spot_falloff(const global DeviceLight* light, float3 wi) {
    float cosine = -dot3(wi, load3(light->direction));
    if (cosine >= light->cos_inner) {
        return 1.0f;
    }
    if (cosine <= light->cos_outer) {
        return 0.0f;
    }
    float x = (cosine - light->cos_outer) / (light->cos_inner - light->cos_outer);
    return x * x * (3.0f - 2.0f * x);
}

/// What light is divided by after `distance`.
static inline float attenuation(const global float* a, float distance) {
    return a[0] + a[1] * distance + a[2] * distance * distance;
}

/// Colour of the light that arrives from unit direction `wi` and `distance`, unshadowed.
static inline float3 arriving_light(const global DeviceLight* light, float3 wi, float distance) {
    float3 color = load3(light->color);
    if (light->kind == SAHL_LIGHT_DIRECTIONAL) {
        return color;
    }
    color /= attenuation(light->attenuation, distance);
    return light->kind == SAHL_LIGHT_SPOT ? color * spot_falloff(light, wi) : color;
}

#endif
