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

static inline float3 min3(float3 a, float3 b) {
    return (float3)(SAHL_MIN(a.x, b.x), SAHL_MIN(a.y, b.y), SAHL_MIN(a.z, b.z));
}

static inline float3 max3(float3 a, float3 b) {
    return (float3)(SAHL_MAX(a.x, b.x), SAHL_MAX(a.y, b.y), SAHL_MAX(a.z, b.z));
}

static inline bool is_nonzero(float3 v) { return v.x != 0.0f || v.y != 0.0f || v.z != 0.0f; }

static inline float3 load3(const global float* p) { return (float3)(p[0], p[1], p[2]); }

/// a·b - c·d to within 1.5 ulp whatever cancels (Jeannerod, Louvet, Muller 2013).
static inline float4 difference_of_products(float4 a, float4 b, float4 c, float4 d) {
    float4 cd = c * d;
    float4 error = fma(-c, d, cd);
    return fma(a, b, -cd) + error;
}

/// log2 of a normal x > 0, relative error below 3e-7: the mantissa is brought to
/// [sqrt(1/2), sqrt(2)) and log m = 2 atanh((m - 1)/(m + 1)) summed to the ninth power.
static inline float log2_positive(float x) {
    int bits = as_int(x);
    int exponent = ((bits - 0x3f3504f3) >> 23);
    float m = as_float(bits - (exponent << 23));
    float s = (m - 1.0f) / (m + 1.0f);
    float s2 = s * s;
    float series =
        fma(s2, fma(s2, fma(s2, fma(s2, 1.0f / 9.0f, 1.0f / 7.0f), 1.0f / 5.0f), 1.0f / 3.0f), 1.0f);
    return fma(2.88539008f * s, series, (float)exponent);
}

/// 2^y for y <= 127, relative error below 2e-7; 0 where the result would be no normal number.
static inline float exp2_bounded(float y) {
    float whole = floor(y + 0.5f);
    float f = (y - whole) * 0.693147181f;
    float p =
        fma(f,
            fma(f,
                fma(f,
                    fma(f, fma(f, fma(f, fma(f, 1.0f / 5040.0f, 1.0f / 720.0f), 1.0f / 120.0f), 1.0f / 24.0f),
                        1.0f / 6.0f),
                    0.5f),
                1.0f),
            1.0f);
    float scale = as_float(((int)SAHL_MAX(whole, -127.0f) + 127) << 23);
    return y < -126.0f ? 0.0f : p * scale;
}

/// x^n for x in [0, 2], n >= 0 and n·log2(x) <= 127; 0^0 = 1. Relative error about
/// 2e-7 (1 + n |log2 x|). The library's pow is neither fast nor the same on every device.
static inline float power(float x, float n) {
    float result = exp2_bounded(n * log2_positive(SAHL_MAX(x, 1.17549435e-38f)));
    return x > 0.0f ? result : (n == 0.0f ? 1.0f : 0.0f);
}

#endif
