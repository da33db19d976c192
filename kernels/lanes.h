// SAHL_LANES rays shaded side by side, as structures of arrays: floatv, intv and uintv hold a number of each,
// realv one in the precision of shading (real.h), and floatv3 and realv3 a vector of each. What a lane gets
// does not depend on its neighbours, and is what scalar arithmetic would give. Lanes that something does not
// concern are computed all the same and left out by select: masks are -1 where they hold.
#ifndef SAHL_LANES_H
#define SAHL_LANES_H

#include "kernels/math.h"
#include "kernels/rays_per_item.h"
#include "kernels/real.h"
#include "kernels/simd.h"

typedef float8 floatv;
typedef int8 intv;
typedef uint8 uintv;
#define as_intv as_int8
#define as_uintv as_uint8
#define as_floatv as_float8
#define convert_floatv convert_float8
#define convert_intv convert_int8
#define vloadv(p) vload8(0, p)
#define vstorev(v, p) vstore8(v, 0, p)

static inline intv lane_numbers(void) { return (intv)(0, 1, 2, 3, 4, 5, 6, 7); }

/// A mask's lanes as bits of a uint.
static inline uint lane_bits(intv mask) { return sign_bits8(mask); }

#define SAHL_DEFINE_VECTORS(number, vector)                                                            \
    typedef struct {                                                                                   \
        number x, y, z;                                                                                \
    } vector;                                                                                          \
    SAHL_OVERLOAD vector add(vector a, vector b) { return (vector){a.x + b.x, a.y + b.y, a.z + b.z}; } \
    SAHL_OVERLOAD vector sub(vector a, vector b) { return (vector){a.x - b.x, a.y - b.y, a.z - b.z}; } \
    SAHL_OVERLOAD vector mul(vector a, vector b) { return (vector){a.x * b.x, a.y * b.y, a.z * b.z}; } \
    SAHL_OVERLOAD vector mul(vector a, number b) { return (vector){a.x * b, a.y * b, a.z * b}; }       \
    SAHL_OVERLOAD vector div(vector a, number b) { return (vector){a.x / b, a.y / b, a.z / b}; }       \
    SAHL_OVERLOAD vector negated(vector a) { return (vector){-a.x, -a.y, -a.z}; }                      \
    SAHL_OVERLOAD number dotv(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }        \
    SAHL_OVERLOAD vector crossv(vector a, vector b) {                                                  \
        return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};          \
    }                                                                                                  \
    SAHL_OVERLOAD vector normalizev(vector v) { return div(v, sqrt(dotv(v, v))); }

SAHL_DEFINE_VECTORS(floatv, floatv3)
SAHL_OVERLOAD floatv where(intv mask, floatv a, floatv b) { return mask ? a : b; }
SAHL_OVERLOAD floatv3 where(intv mask, floatv3 a, floatv3 b) {
    return (floatv3){mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

#ifdef cl_khr_fp64
typedef double8 realv;
typedef long8 real_maskv;  // of comparisons
#define convert_realv convert_double8
#define convert_real_maskv convert_long8
SAHL_DEFINE_VECTORS(realv, realv3)
SAHL_OVERLOAD realv where(real_maskv mask, realv a, realv b) { return mask ? a : b; }
SAHL_OVERLOAD realv where(intv mask, realv a, realv b) { return convert_long8(mask) ? a : b; }
SAHL_OVERLOAD realv3 where(real_maskv mask, realv3 a, realv3 b) {
    return (realv3){mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
SAHL_OVERLOAD realv3 where(intv mask, realv3 a, realv3 b) { return where(convert_long8(mask), a, b); }
#else
typedef floatv realv;
typedef floatv3 realv3;
typedef intv real_maskv;
#define convert_realv convert_float8
#define convert_real_maskv convert_int8
#endif

static inline floatv3 same3(float3 v) { return (floatv3){(floatv)(v.x), (floatv)(v.y), (floatv)(v.z)}; }
static inline realv3 same3_real(real3 v) { return (realv3){(realv)(v.x), (realv)(v.y), (realv)(v.z)}; }

static inline floatv3 roundv(realv3 v) {
    return (floatv3){convert_floatv(v.x), convert_floatv(v.y), convert_floatv(v.z)};
}

static inline realv3 widen(floatv3 v) {
    return (realv3){convert_realv(v.x), convert_realv(v.y), convert_realv(v.z)};
}

static inline intv nonzerov(floatv3 v) { return (v.x != 0.0f) | (v.y != 0.0f) | (v.z != 0.0f); }

static inline floatv max_absv(floatv3 v) {
    floatv x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
    floatv larger = SAHL_MAX(x, y);
    return SAHL_MAX(larger, z);
}

/// A place in global memory for each lane.
typedef struct {
    const global float* of[SAHL_LANES];
} LanePlaces;

static inline LanePlaces places(const global float* base, uintv offset) {
    return (LanePlaces){{base + offset.s0, base + offset.s1, base + offset.s2, base + offset.s3,
                         base + offset.s4, base + offset.s5, base + offset.s6, base + offset.s7}};
}

/// Number k from each place on.
static inline floatv gather(const LanePlaces* at, uint k) {
    return (floatv)(at->of[0][k], at->of[1][k], at->of[2][k], at->of[3][k], at->of[4][k], at->of[5][k],
                    at->of[6][k], at->of[7][k]);
}

/// Numbers k to k + 7 from each place on.
static inline void gather8(const LanePlaces* at, uint k, floatv* numbers) {
#pragma unroll
    for (uint lane = 0; lane < SAHL_LANES; ++lane) {
        numbers[lane] = vload8(0, at->of[lane] + k);
    }
    transpose8(numbers);
}

static inline floatv3 vectors_of(const floatv* numbers) {
    return (floatv3){numbers[0], numbers[1], numbers[2]};
}

/// Numbers in two floats, the second being what the first lacks.
static inline realv reals_of(const floatv* numbers) {
    return convert_realv(numbers[0]) + convert_realv(numbers[1]);
}

/// Three floats and, behind them, the three that they lack.
static inline realv3 real_vectors_of(const floatv* numbers) {
    return add(widen(vectors_of(numbers)), widen(vectors_of(numbers + 3)));
}

#endif
