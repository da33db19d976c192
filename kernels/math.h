// Arithmetic that every kernel shares. Contraction is off wherever this header is included, so
// that all versions of a kernel and all devices round alike; fma() is written where it is wanted.
#ifndef SAHL_MATH_H
#define SAHL_MATH_H

#pragma OPENCL FP_CONTRACT OFF

// `a` when either is NaN is not promised: callers say why NaN cannot come or does not matter.
#define SAHL_MIN(a, b) ((a) < (b) ? (a) : (b))
#define SAHL_MAX(a, b) ((a) > (b) ? (a) : (b))

static inline float dot3(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline float3 cross3(float3 a, float3 b) {
    return (float3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline float3 normalize3(float3 v) { return v / sqrt(dot3(v, v)); }

static inline float max_abs3(float3 v) {
    float3 a = fabs(v);
    return SAHL_MAX(SAHL_MAX(a.x, a.y), a.z);
}

static inline bool is_nonzero(float3 v) { return v.x != 0.0f || v.y != 0.0f || v.z != 0.0f; }

static inline float3 load3(const global float* p) { return (float3)(p[0], p[1], p[2]); }

/// a·b - c·d to within 1.5 ulp whatever cancels (Jeannerod, Louvet, Muller 2013).
static inline float4 difference_of_products(float4 a, float4 b, float4 c, float4 d) {
    float4 cd = c * d;
    float4 error = fma(-c, d, cd);
    return fma(a, b, -cd) + error;
}

/// 1/d, with ±1e18 for components that are (nearly) 0: 0·inf would be NaN.
#define SAHL_DEFINE_FINITE_INVERSE(FLOAT, INT)                                           \
    static inline __attribute__((overloadable)) FLOAT finite_inverse(FLOAT d) {          \
        const FLOAT magnitude = fabs(d);                                                 \
        const FLOAT inverse = 1.0f / (magnitude < 1e-18f ? (FLOAT)(1e-18f) : magnitude); \
        return as_##FLOAT(as_##INT(inverse) | (as_##INT(d) & (int)0x80000000));          \
    }
SAHL_DEFINE_FINITE_INVERSE(float4, int4)
SAHL_DEFINE_FINITE_INVERSE(float8, int8)
SAHL_DEFINE_FINITE_INVERSE(float16, int16)

#endif
