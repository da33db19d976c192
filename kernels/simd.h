// Comparison masks as integers: AVX-512, AVX2 and plain OpenCL behind one set of names.
// Bit k of a mask is lane k; comparisons with NaN are false. SAHL_PLAIN_OPENCL forces the plain
// version, which other CPUs and GPUs use; SAHL_NO_AVX512 that of AVX2 where it is to be had.
#ifndef SAHL_SIMD_H
#define SAHL_SIMD_H

#include "kernels/math.h"

#if defined(__AVX512F__) && defined(__AVX512VL__) && !defined(SAHL_NO_AVX512) && !defined(SAHL_PLAIN_OPENCL)

// The immediate is the predicate of vcmpps: 2 is <=, 13 is >=, ordered.
#define SAHL_LE_OS 2
#define SAHL_GE_OS 13
static inline uint mask8_le(float8 a, float8 b) {
    return __builtin_ia32_cmpps256_mask(a, b, SAHL_LE_OS, (uchar)0xff);
}
static inline uint mask16_le(float16 a, float16 b) {
    return __builtin_ia32_cmpps512_mask(a, b, SAHL_LE_OS, (ushort)0xffff, 4);
}
static inline uint mask16_ge(float16 a, float16 b) {
    return __builtin_ia32_cmpps512_mask(a, b, SAHL_GE_OS, (ushort)0xffff, 4);
}

#else

#if defined(__AVX2__) && !defined(SAHL_PLAIN_OPENCL)
static inline uint sign_bits8(int8 lanes) { return (uint)__builtin_ia32_movmskps256(as_float8(lanes)); }
#else
static inline uint sign_bits8(int8 lanes) {
    int8 bits = lanes & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    int4 quarter = bits.lo | bits.hi;
    int2 half_of_it = quarter.lo | quarter.hi;
    return (uint)(half_of_it.x | half_of_it.y);
}
#endif

static inline uint mask8_le(float8 a, float8 b) { return sign_bits8(a <= b); }
static inline uint mask16_le(float16 a, float16 b) {
    return sign_bits8(a.lo <= b.lo) | sign_bits8(a.hi <= b.hi) << 8;
}
static inline uint mask16_ge(float16 a, float16 b) {
    return sign_bits8(a.lo >= b.lo) | sign_bits8(a.hi >= b.hi) << 8;
}

#endif

/// Lanes of a float4 comparison.
static inline uint mask4(int4 lanes) {
    int4 bits = lanes & (int4)(1, 2, 4, 8);
    return (uint)(bits.x | bits.y | bits.z | bits.w);
}

/// The lowest set bit's number; `mask` is not 0.
static inline uint lowest_lane(uint mask) { return 31u - clz(mask & (0u - mask)); }

/// The highest set bit's number; `mask` is not 0.
static inline uint highest_lane(uint mask) { return 31u - clz(mask); }

/// Moves bit s of an 8-bit mask to bit s ^ octant.
static inline uint permute_by_octant(uint mask, uint octant) {
    mask = (octant & 1u) ? ((mask & 0x55u) << 1 | (mask >> 1 & 0x55u)) : mask;
    mask = (octant & 2u) ? ((mask & 0x33u) << 2 | (mask >> 2 & 0x33u)) : mask;
    return (octant & 4u) ? ((mask & 0x0fu) << 4 | mask >> 4) : mask;
}

#endif
