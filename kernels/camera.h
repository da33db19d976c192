// Camera samples: which pixel a sample number belongs to and the ray through it.
#ifndef SAHL_CAMERA_H
#define SAHL_CAMERA_H

#include "kernels/device_types.h"
#include "kernels/math.h"
#include "kernels/sampling.h"

// Pixels are numbered in strips of this many rows, column by column, so that neighbours in a batch
// are neighbours in the image.
#define SAHL_STRIP_HEIGHT 8u

/// Column and row in the crop of its pixel number `index`.
static inline uint2 crop_pixel(uint index, uint width, uint height) {
    uint strip = index / (SAHL_STRIP_HEIGHT * width);
    uint rest = index - strip * SAHL_STRIP_HEIGHT * width;
    uint top = strip * SAHL_STRIP_HEIGHT;
    uint rows = SAHL_MIN(SAHL_STRIP_HEIGHT, height - top);
    return (uint2)(rest / rows, top + rest % rows);
}

/// Unit direction through image position `p` (pixels from the top left corner, y down).
static inline float3 camera_direction(const CameraConstants* camera, float2 p) {
    float x = p.x - camera->half_width, y = p.y - camera->half_height;
    return normalize3(
        (float3)(camera->forward[0] + x * camera->step_x[0] + y * camera->step_y[0],
                 camera->forward[1] + x * camera->step_x[1] + y * camera->step_y[1],
                 camera->forward[2] + x * camera->step_x[2] + y * camera->step_y[2]));
}

#endif
