// Where the samples of a pixel lie.
#ifndef SAHL_SAMPLING_H
#define SAHL_SAMPLING_H

#include "kernels/math.h"
#include "kernels/rng.h"

static inline uint reverse_bits(uint v) {
    v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
    v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
    v = (v >> 8 & 0x00ff00ffu) | (v & 0x00ff00ffu) << 8;
    return v >> 16 | v << 16;
}

/// Position in [0, 1)² of sample i of `spp` in the pixel at (x, y): the centre for one sample,
/// else a Hammersley set, jittered in y and digitally scrambled in x by pixel (Kollig and Keller
/// 2002, "Efficient Multidimensional Sampling"): one sample in each of spp rows, and for powers of
/// two one in each of spp columns and in each elementary interval.
static inline float2 pixel_sample(uint x, uint y, uint i, uint spp, uint2 seed) {
    if (spp == 1u) {
        return (float2)(0.5f, 0.5f);
    }
    uint scramble = random_words(x, y, 0u, spp, SAHL_DIMENSION_PIXEL_SCRAMBLE, seed).x;
    float jitter = uniform_float(random_words(x, y, i, spp, SAHL_DIMENSION_PIXEL_JITTER, seed).x);
    float row = ((float)i + jitter) / (float)spp;
    return (float2)(uniform_float(reverse_bits(i) ^ scramble), SAHL_MIN(row, 0x1.fffffep-1f));
}

#endif
