// Camera samples: which pixel a sample number belongs to and the ray through it.
#ifndef SAHL_CAMERA_H
#define SAHL_CAMERA_H

#include "kernels/device_types.h"
#include "kernels/lanes.h"
#include "kernels/sampling.h"

// Pixels are numbered in strips of this many rows, in blocks of so many columns, row by row, so that
// neighbours in a batch are neighbours in the image: eight make 4 x 2 pixels, sixteen 4 x 4.
#define SAHL_STRIP_HEIGHT 8u
#define SAHL_BLOCK_COLUMNS 4u

/// Column and row in the crop of its pixel number `index`.
static inline uint2 crop_pixel(uint index, uint width, uint height) {
    uint strip = index / (SAHL_STRIP_HEIGHT * width);
    uint rest = index - strip * SAHL_STRIP_HEIGHT * width;
    uint top = strip * SAHL_STRIP_HEIGHT;
    uint rows = SAHL_MIN(SAHL_STRIP_HEIGHT, height - top);
    uint left = rest / (rows * SAHL_BLOCK_COLUMNS) * SAHL_BLOCK_COLUMNS;
    uint columns = SAHL_MIN(SAHL_BLOCK_COLUMNS, width - left);
    rest -= left * rows;
    return (uint2)(left + rest % columns, top + rest / columns);
}

static inline real3 camera_vector(const float* value, const float* lacking) {
    return (real3)((real)value[0] + (real)lacking[0], (real)value[1] + (real)lacking[1],
                   (real)value[2] + (real)lacking[2]);
}

/// Positions in the image, in pixels, y down: whole ones and the rest.
typedef struct {
    uint x[SAHL_LANES], y[SAHL_LANES];
    float in_x[SAHL_LANES], in_y[SAHL_LANES];
} CameraSamples;

static inline void set_camera_sample(CameraSamples* samples, uint k, uint x, uint y, float2 in_pixel) {
    samples->x[k] = x;
    samples->y[k] = y;
    samples->in_x[k] = in_pixel.x;
    samples->in_y[k] = in_pixel.y;
}

/// Unit directions through the samples.
static inline realv3 camera_directions(const CameraConstants* camera, const CameraSamples* samples) {
    const realv right =
        convert_realv(vloadv(samples->x)) - (real)camera->half_width + convert_realv(vloadv(samples->in_x));
    const realv down =
        convert_realv(vloadv(samples->y)) - (real)camera->half_height + convert_realv(vloadv(samples->in_y));
    const realv3 forward = same3_real(camera_vector(camera->forward, camera->forward_low));
    const realv3 step_x = same3_real(camera_vector(camera->step_x, camera->step_x_low));
    const realv3 step_y = same3_real(camera_vector(camera->step_y, camera->step_y_low));
    return normalizev(add(add(forward, mul(step_x, right)), mul(step_y, down)));
}

#endif
