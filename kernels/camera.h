// Camera samples: which pixel a sample number belongs to and the ray through it.
#ifndef SAHL_CAMERA_H
#define SAHL_CAMERA_H

#include "kernels/device_types.h"
#include "kernels/real.h"
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

static inline real3 camera_vector(const float* value, const float* lacking) {
    return (real3)((real)value[0] + (real)lacking[0], (real)value[1] + (real)lacking[1],
                   (real)value[2] + (real)lacking[2]);
}

/// Unit direction through position `in_pixel` of the pixel at (x, y), y down.
static inline real3 camera_direction(const CameraConstants* camera, uint x, uint y, float2 in_pixel) {
    real right = (real)x - (real)camera->half_width + (real)in_pixel.x;
    real down = (real)y - (real)camera->half_height + (real)in_pixel.y;
    return normalize3_real(camera_vector(camera->forward, camera->forward_low) +
                           camera_vector(camera->step_x, camera->step_x_low) * right +
                           camera_vector(camera->step_y, camera->step_y_low) * down);
}

#endif
