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

/// Where a pixel of a crop is.
typedef struct {
    uint left, columns;  // of its block
    uint top, rows;      // of its strip
    uint column, row;    // in the block
} PixelPlace;

/// Of the crop's pixel number `index`.
static inline PixelPlace pixel_place(uint index, uint width, uint height) {
    PixelPlace place;
    const uint strip = index / (SAHL_STRIP_HEIGHT * width);
    uint rest = index - strip * SAHL_STRIP_HEIGHT * width;
    place.top = strip * SAHL_STRIP_HEIGHT;
    place.rows = SAHL_MIN(SAHL_STRIP_HEIGHT, height - place.top);
    place.left = rest / (place.rows * SAHL_BLOCK_COLUMNS) * SAHL_BLOCK_COLUMNS;
    place.columns = SAHL_MIN(SAHL_BLOCK_COLUMNS, width - place.left);
    rest -= place.left * place.rows;
    place.column = rest % place.columns;
    place.row = rest / place.columns;
    return place;
}

/// Columns and rows in the crop of pixels.
typedef struct {
    uintv x, y;
} CropPixels;

/// Of SAHL_LANES samples of `wave` from number `i` on; behind the last, the last.
static inline CropPixels crop_pixels(const WaveConstants* wave, ulong first, uint i) {
    CropPixels pixels;
    if (wave->samples == 1u && i + SAHL_LANES <= wave->count) {
        const PixelPlace place = pixel_place((uint)(first + i), wave->crop_width, wave->crop_height);
        // Mostly they are two rows of one block.
        if (place.columns == SAHL_BLOCK_COLUMNS && place.column == 0u && place.row + 2u <= place.rows) {
            const uintv lane = as_uintv(lane_numbers());
            pixels.x = place.left + lane % SAHL_BLOCK_COLUMNS;
            pixels.y = place.top + place.row + lane / SAHL_BLOCK_COLUMNS;
            return pixels;
        }
    }
    for (uint k = 0; k < SAHL_LANES; ++k) {
        const ulong sample = first + SAHL_MIN(i + k, wave->count - 1u);
        const PixelPlace own =
            pixel_place((uint)(sample / wave->samples), wave->crop_width, wave->crop_height);
        ((uint*)&pixels.x)[k] = own.left + own.column;
        ((uint*)&pixels.y)[k] = own.top + own.row;
    }
    return pixels;
}

static inline real3 camera_vector(const float* value, const float* lacking) {
    return (real3)((real)value[0] + (real)lacking[0], (real)value[1] + (real)lacking[1],
                   (real)value[2] + (real)lacking[2]);
}

/// Positions in the image, in pixels, y down: whole ones and the rest.
typedef struct {
    uintv x, y;
    floatv in_x, in_y;
} CameraSamples;

/// Of the samples from number `i` on, in `pixels` of the crop.
static inline CameraSamples camera_samples(const WaveConstants* wave, ulong first, uint i,
                                           const CropPixels* pixels) {
    CameraSamples samples;
    samples.x = wave->crop_x + pixels->x;
    samples.y = wave->crop_y + pixels->y;
    samples.in_x = (floatv)(0.5f);
    samples.in_y = (floatv)(0.5f);
    if (wave->spp == 1u) {
        return samples;
    }
    const uint2 seed = (uint2)(wave->seed_low, wave->seed_high);
    for (uint k = 0; k < SAHL_LANES; ++k) {
        const uint of_pixel = (uint)((first + SAHL_MIN(i + k, wave->count - 1u)) % wave->samples);
        const float2 in_pixel = pixel_sample(((const uint*)&samples.x)[k], ((const uint*)&samples.y)[k],
                                             wave->first_sample + of_pixel, wave->spp, seed);
        ((float*)&samples.in_x)[k] = in_pixel.x;
        ((float*)&samples.in_y)[k] = in_pixel.y;
    }
    return samples;
}

/// Unit directions through the samples.
static inline realv3 camera_directions(const CameraConstants* camera, const CameraSamples* samples) {
    const realv right = convert_realv(samples->x) - (real)camera->half_width + convert_realv(samples->in_x);
    const realv down = convert_realv(samples->y) - (real)camera->half_height + convert_realv(samples->in_y);
    const realv3 forward = same3_real(camera_vector(camera->forward, camera->forward_low));
    const realv3 step_x = same3_real(camera_vector(camera->step_x, camera->step_x_low));
    const realv3 step_y = same3_real(camera_vector(camera->step_y, camera->step_y_low));
    return normalizev(add(add(forward, mul(step_x, right)), mul(step_y, down)));
}

#endif
