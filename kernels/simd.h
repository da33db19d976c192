// The few idioms that OpenCL C has no fast words for: AVX-512, AVX2 and plain OpenCL behind one set
// of names. SAHL_PLAIN_OPENCL forces the plain version, which other CPUs and GPUs use;
// SAHL_NO_AVX512 that of AVX2 where it is to be had.
//
// Rays that go together do so in groups of SAHL_GROUP_RAYS, as wide as registers are: floatg, intg and uintg
// hold a number of each ray. What is wider takes two registers each time, of which AVX2 has sixteen.
//
// Two kinds of masks: bits of a uint (bit k is lane k) where lanes are looked at one by one, and LaneMask for
// groups of rays: bits on AVX-512, whole lanes elsewhere. Comparisons with NaN are false.
#ifndef SAHL_SIMD_H
#define SAHL_SIMD_H

#include "kernels/math.h"

#define SAHL_OVERLOAD static inline __attribute__((overloadable))
#define SAHL_INLINE static inline __attribute__((always_inline))
// For large bodies: PoCL makes two functions of a kernel, each of which would have its own.
#define SAHL_NOINLINE static inline __attribute__((noinline))

#if defined(__AVX512F__) && defined(__AVX512VL__) && !defined(SAHL_NO_AVX512) && !defined(SAHL_PLAIN_OPENCL)
#define SAHL_AVX512
#elif defined(__AVX2__) && !defined(SAHL_PLAIN_OPENCL)
#define SAHL_AVX2
#endif

/// The lowest set bit's number; `mask` is not 0.
#if defined(SAHL_AVX512) || defined(SAHL_AVX2)
static inline uint lowest_lane(uint mask) { return (uint)__builtin_ctz(mask); }
#else
static inline uint lowest_lane(uint mask) { return 31u - clz(mask & (0u - mask)); }
#endif

/// The highest set bit's number; `mask` is not 0.
static inline uint highest_lane(uint mask) { return 31u - clz(mask); }

/// Moves bit s of an 8-bit mask to bit s ^ octant.
static inline uint permute_by_octant(uint mask, uint octant) {
    mask = (octant & 1u) ? ((mask & 0x55u) << 1 | (mask >> 1 & 0x55u)) : mask;
    mask = (octant & 2u) ? ((mask & 0x33u) << 2 | (mask >> 2 & 0x33u)) : mask;
    return (octant & 4u) ? ((mask & 0x0fu) << 4 | mask >> 4) : mask;
}

/// Lanes of a float4 comparison.
static inline uint mask4(int4 lanes) {
#if defined(SAHL_AVX512) || defined(SAHL_AVX2)
    return (uint)__builtin_ia32_movmskps(as_float4(lanes));
#else
    int4 bits = lanes & (int4)(1, 2, 4, 8);
    return (uint)(bits.x | bits.y | bits.z | bits.w);
#endif
}

/// Lanes of a float8 comparison.
static inline uint sign_bits8(int8 lanes) {
#if defined(SAHL_AVX512) || defined(SAHL_AVX2)
    return (uint)__builtin_ia32_movmskps256(as_float8(lanes));
#else
    int8 bits = lanes & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    int4 quarter = bits.lo | bits.hi;
    int2 half_of_it = quarter.lo | quarter.hi;
    return (uint)(half_of_it.x | half_of_it.y);
#endif
}

static inline float least8(float8 v) {
    float4 b = SAHL_MIN(v.lo, v.hi);
    float2 c = SAHL_MIN(b.lo, b.hi);
    return SAHL_MIN(c.x, c.y);
}

static inline float greatest8(float8 v) {
    float4 b = SAHL_MAX(v.lo, v.hi);
    float2 c = SAHL_MAX(b.lo, b.hi);
    return SAHL_MAX(c.x, c.y);
}

#ifdef SAHL_AVX512

#define SAHL_GROUP_RAYS 16
typedef float16 floatg;
typedef int16 intg;
typedef uint16 uintg;
#define as_floatg as_float16
#define as_intg as_int16
#define as_uintg as_uint16
#define vloadg vload16
#define vstoreg vstore16

// The immediates are predicates of vcmpps, ordered where that is a choice.
#define SAHL_COMPARE(a, b, predicate) \
    ((LaneMask)__builtin_ia32_cmpps512_mask(a, b, predicate, (ushort)0xffff, 4))
typedef ushort LaneMask;
SAHL_OVERLOAD LaneMask equalg(floatg a, floatg b) { return SAHL_COMPARE(a, b, 0); }
SAHL_OVERLOAD LaneMask lessg(floatg a, floatg b) { return SAHL_COMPARE(a, b, 1); }
SAHL_OVERLOAD LaneMask less_equalg(floatg a, floatg b) { return SAHL_COMPARE(a, b, 2); }
SAHL_OVERLOAD LaneMask equalg(intg a, intg b) {
    return (LaneMask)__builtin_ia32_cmpd512_mask(a, b, 0, (ushort)0xffff);
}
SAHL_OVERLOAD LaneMask lessg(intg a, intg b) {
    return (LaneMask)__builtin_ia32_cmpd512_mask(a, b, 1, (ushort)0xffff);
}
SAHL_OVERLOAD floatg selectg(LaneMask lanes, floatg a, floatg b) {
    return __builtin_ia32_selectps_512(lanes, a, b);
}
SAHL_OVERLOAD intg selectg(LaneMask lanes, intg a, intg b) { return __builtin_ia32_selectd_512(lanes, a, b); }
static inline bool anyg(LaneMask lanes) { return lanes != 0; }
static inline uint bitsg(LaneMask lanes) { return lanes; }
static inline LaneMask notg(LaneMask lanes) { return (LaneMask)~lanes; }
static inline float leastg(floatg v) { return least8(SAHL_MIN(v.lo, v.hi)); }
static inline float greatestg(floatg v) { return greatest8(SAHL_MAX(v.lo, v.hi)); }

static inline uint mask8_le(float8 a, float8 b) { return __builtin_ia32_cmpps256_mask(a, b, 2, (uchar)0xff); }
static inline uint mask16_le(float16 a, float16 b) { return less_equalg(a, b); }

#else

#define SAHL_GROUP_RAYS 8
typedef float8 floatg;
typedef int8 intg;
typedef uint8 uintg;
#define as_floatg as_float8
#define as_intg as_int8
#define as_uintg as_uint8
#define vloadg vload8
#define vstoreg vstore8

typedef int8 LaneMask;
#ifdef SAHL_AVX2
// In assembly, for LLVM 15 knows too much of comparisons: it packs the masks of those that are combined into
// bytes and unpacks what results, which takes longer than the comparisons.
#define SAHL_DEFINE_COMPARISON(NAME, GROUP, INSTRUCTION)    \
    SAHL_OVERLOAD LaneMask NAME(GROUP a, GROUP b) {         \
        LaneMask mask;                                      \
        __asm__(INSTRUCTION : "=x"(mask) : "x"(a), "x"(b)); \
        return mask;                                        \
    }
SAHL_DEFINE_COMPARISON(equalg, floatg, "vcmpeqps %2, %1, %0")
SAHL_DEFINE_COMPARISON(lessg, floatg, "vcmpltps %2, %1, %0")
SAHL_DEFINE_COMPARISON(less_equalg, floatg, "vcmpleps %2, %1, %0")
SAHL_DEFINE_COMPARISON(equalg, intg, "vpcmpeqd %2, %1, %0")
SAHL_DEFINE_COMPARISON(lessg, intg, "vpcmpgtd %1, %2, %0")
#else
SAHL_OVERLOAD LaneMask equalg(floatg a, floatg b) { return a == b; }
SAHL_OVERLOAD LaneMask lessg(floatg a, floatg b) { return a < b; }
SAHL_OVERLOAD LaneMask less_equalg(floatg a, floatg b) { return a <= b; }
SAHL_OVERLOAD LaneMask equalg(intg a, intg b) { return a == b; }
SAHL_OVERLOAD LaneMask lessg(intg a, intg b) { return a < b; }
#endif
SAHL_OVERLOAD floatg selectg(LaneMask lanes, floatg a, floatg b) { return select(b, a, lanes); }
SAHL_OVERLOAD intg selectg(LaneMask lanes, intg a, intg b) { return select(b, a, lanes); }
static inline bool anyg(LaneMask lanes) { return sign_bits8(lanes) != 0u; }
static inline uint bitsg(LaneMask lanes) { return sign_bits8(lanes); }
static inline LaneMask notg(LaneMask lanes) { return ~lanes; }
static inline float leastg(floatg v) { return least8(v); }
static inline float greatestg(floatg v) { return greatest8(v); }

static inline uint mask8_le(float8 a, float8 b) { return sign_bits8(a <= b); }
static inline uint mask16_le(float16 a, float16 b) {
    const int16 lanes = a <= b;
    return sign_bits8(lanes.lo) | sign_bits8(lanes.hi) << 8;
}

#endif

static inline uint mask16_ge(float16 a, float16 b) { return mask16_le(b, a); }

/// Rows of two 4 x 4 squares, one beside the other, become their columns, in place.
SAHL_INLINE void transpose4(float8* rows) {
    float8 pairs[4];
#pragma unroll
    for (uint k = 0; k < 4u; k += 2u) {
        const float8 a = rows[k], b = rows[k + 1u];
        pairs[k] = (float8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5);
        pairs[k + 1u] = (float8)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7);
    }
#pragma unroll
    for (uint odd = 0; odd < 2u; ++odd) {
        const float8 a = pairs[odd], b = pairs[2u + odd];
        rows[2u * odd] = (float8)(a.s01, b.s01, a.s45, b.s45);
        rows[2u * odd + 1u] = (float8)(a.s23, b.s23, a.s67, b.s67);
    }
}

/// Rows of an 8 x 8 square become its columns, in place.
SAHL_INLINE void transpose8(float8* rows) {
    transpose4(rows);
    transpose4(rows + 4);
#pragma unroll
    for (uint k = 0; k < 4u; ++k) {
        const float8 upper = rows[k], lower = rows[k + 4u];
        rows[k] = (float8)(upper.lo, lower.lo);
        rows[k + 4u] = (float8)(upper.hi, lower.hi);
    }
}

/// Asks for `lines` cache lines from `p` on.
static inline void prefetch_lines(const global void* p, uint lines) {
#if defined(SAHL_AVX512) || defined(SAHL_AVX2)
#pragma unroll
    for (uint line = 0; line < lines; ++line) {
        __builtin_prefetch((const void*)((ulong)p + 64u * line));
    }
#else
    (void)p;
    (void)lines;
#endif
}

#endif
