// Lights: which way they are and what arrives from them when nothing is in between.
#ifndef SAHL_LIGHT_H
#define SAHL_LIGHT_H

#include "kernels/device_types.h"
#include "kernels/math.h"

/// From `position` to the light: a point light's distance is the vector's length, a directional
/// light's is infinite.
static inline float3 vector_to_light(const global DeviceLight* light, float3 position) {
    float3 p = load3(light->position);
    return light->kind == SAHL_LIGHT_POINT ? p - position : p;
}

/// The largest t of a shadow ray along vector_to_light.
static inline float shadow_t_max(const global DeviceLight* light) {
    return light->kind == SAHL_LIGHT_POINT ? 1.0f : INFINITY;
}

/// Colour of the light at `distance`, unshadowed.
static inline float3 arriving_light(const global DeviceLight* light, float distance) {
    float3 color = load3(light->color);
    if (light->kind == SAHL_LIGHT_DIRECTIONAL) {
        return color;
    }
    const global float* a = light->attenuation;
    return color / (a[0] + a[1] * distance + a[2] * distance * distance);
}

#endif
