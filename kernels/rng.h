// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011, "Parallel Random
// Numbers: As Easy as 1, 2, 3"). A number is a function of what it is for, never of the order in
// which work is done. Integers only: the same on every device.
#ifndef SAHL_RNG_H
#define SAHL_RNG_H

/// Four random words for a counter and a key.
static inline uint4 philox4x32(uint4 counter, uint2 key) {
    for (int round = 0; round < 10; ++round) {
        uint high0 = mul_hi(0xd2511f53u, counter.x), low0 = 0xd2511f53u * counter.x;
        uint high1 = mul_hi(0xcd9e8d57u, counter.z), low1 = 0xcd9e8d57u * counter.z;
        counter = (uint4)(high1 ^ counter.y ^ key.x, low1, high0 ^ counter.w ^ key.y, low0);
        key += (uint2)(0x9e3779b9u, 0xbb67ae85u);
    }
    return counter;
}

/// Uniform in [0, 1), a multiple of 2^-24.
static inline float uniform_float(uint bits) { return (float)(bits >> 8) * 0x1p-24f; }

// What a random number is used for.
#define SAHL_DIMENSION_PIXEL_SCRAMBLE 0u
#define SAHL_DIMENSION_PIXEL_JITTER 1u

/// The random words of one dimension of sample `sample` of `spp` in the pixel at (x, y) of the
/// whole image.
static inline uint4 random_words(uint x, uint y, uint sample, uint spp, uint dimension, uint2 seed) {
    return philox4x32((uint4)(x | y << 16, sample, spp, dimension), seed);
}

#endif
