// Powers of lanes: exp2 and log2 by polynomials, as the library's pow is neither fast nor the same on every
// device.
#ifndef SAHL_POWER_H
#define SAHL_POWER_H

#include "kernels/lanes.h"

/// log2 of normal x > 0, relative error below 3e-7: the mantissa is brought to
/// [sqrt(1/2), sqrt(2)) and log m = 2 atanh((m - 1)/(m + 1)) summed to the ninth power.
static inline floatv log2_positive(floatv x) {
    intv bits = as_intv(x);
    intv exponent = (bits - 0x3f3504f3) >> 23;
    floatv m = as_floatv(bits - (exponent << 23));
    floatv s = (m - 1.0f) / (m + 1.0f);
    floatv s2 = s * s;
    floatv series = fma(s2, (floatv)(1.0f / 9.0f), (floatv)(1.0f / 7.0f));
    series = fma(s2, series, (floatv)(1.0f / 5.0f));
    series = fma(s2, series, (floatv)(1.0f / 3.0f));
    series = fma(s2, series, (floatv)(1.0f));
    return fma(2.88539008f * s, series, convert_floatv(exponent));
}

/// 2^y for y <= 127, relative error below 2e-7; 0 where the result would be no normal number.
static inline floatv exp2_bounded(floatv y) {
    floatv whole = floor(y + 0.5f);
    floatv f = (y - whole) * 0.693147181f;
    floatv p = fma(f, (floatv)(1.0f / 5040.0f), (floatv)(1.0f / 720.0f));
    p = fma(f, p, (floatv)(1.0f / 120.0f));
    p = fma(f, p, (floatv)(1.0f / 24.0f));
    p = fma(f, p, (floatv)(1.0f / 6.0f));
    p = fma(f, p, (floatv)(0.5f));
    p = fma(f, p, (floatv)(1.0f));
    p = fma(f, p, (floatv)(1.0f));
    floatv scale = as_floatv((convert_intv(SAHL_MAX(whole, (floatv)(-127.0f))) + 127) << 23);
    return where(y < -126.0f, (floatv)(0.0f), p * scale);
}

/// x^n for x in [0, 2], n >= 0 and n·log2(x) <= 127; 0^0 = 1. Relative error about
/// 2e-7 (1 + n |log2 x|).
static inline floatv power(floatv x, floatv n) {
    floatv result = exp2_bounded(n * log2_positive(SAHL_MAX(x, (floatv)(1.17549435e-38f))));
    return where(x > 0.0f, result, where(n == 0.0f, (floatv)(1.0f), (floatv)(0.0f)));
}

#endif
