// Powers of lanes: exp2 and log2 by polynomials, as the library's pow is neither fast nor the same on every
// device.
#ifndef SAHL_POWER_H
#define SAHL_POWER_H

#include "kernels/lanes.h"

// The polynomials interpolate at Chebyshev's nodes, and are summed up in pairs, as Estrin (1960) does: each
// step waits for the one before.

/// log2 of normal x > 0, relative error below 3e-7: the mantissa is brought to
/// [sqrt(1/2), sqrt(2)), and log m = 2 atanh s with s = (m - 1)/(m + 1).
static inline floatv log2_positive(floatv x) {
    intv bits = as_intv(x);
    intv exponent = (bits - 0x3f3504f3) >> 23;
    floatv m = as_floatv(bits - (exponent << 23));
    floatv s = (m - 1.0f) / (m + 1.0f);
    floatv s2 = s * s, s4 = s2 * s2;
    floatv low = fma(s2, (floatv)(0.333333425f), (floatv)(1.0f));
    floatv high = fma(s2, (floatv)(0.147899747f), (floatv)(0.199943903f));
    return fma(2.88539008f * s, fma(s4, high, low), convert_floatv(exponent));
}

/// 2^y for y <= 127, relative error below 2e-7; 0 where the result would be no normal number.
static inline floatv exp2_bounded(floatv y) {
    // Added to y it leaves a whole number, in the lowest bits.
    const float whole = 0x1.8p23f;
    floatv bounded = SAHL_MAX(y, (floatv)(-127.0f));
    floatv shifted = bounded + whole;
    floatv f = bounded - (shifted - whole);
    floatv f2 = f * f, f4 = f2 * f2;
    floatv low = fma(f, (floatv)(0.693147188f), (floatv)(1.0f));
    floatv middle = fma(f, (floatv)(0.0555035711f), (floatv)(0.240226508f));
    floatv high = fma(f, (floatv)(0.00133908634f), (floatv)(0.00961808256f));
    high = fma(f2, (floatv)(0.000154531629f), high);
    floatv p = fma(f4, high, fma(f2, middle, low));
    floatv scale = as_floatv((as_intv(shifted) << 23) + (127 << 23));
    return where(y < -126.0f, (floatv)(0.0f), p * scale);
}

/// x^n for x in [0, 2], n >= 0 and n·log2(x) <= 127; 0^0 = 1. Relative error about
/// 2e-7 (1 + n |log2 x|).
static inline floatv power(floatv x, floatv n) {
    floatv result = exp2_bounded(n * log2_positive(SAHL_MAX(x, (floatv)(1.17549435e-38f))));
    return where(x > 0.0f, result, where(n == 0.0f, (floatv)(1.0f), (floatv)(0.0f)));
}

#endif
