// What the device can do at most: memory bandwidth and fused multiply-adds. Profiles compare kernels with
// these (engine/profile/calibrate.h).

#include "kernels/math.h"

/// a = b + s c (McCalpin 1995, STREAM's triad) over `vectors` float16; a work-item takes `per_item`
/// neighbours.
kernel void triad(global float* a, const global float* b, const global float* c, const float s,
                  const uint vectors, const uint per_item) {
    const uint first = (uint)get_global_id(0) * per_item;
    const uint end = SAHL_MIN(first + per_item, vectors);
    for (uint i = first; i < end; ++i) {
        vstore16(fma((float16)(s), vload16(i, c), vload16(i, b)), i, a);
    }
}

#ifdef __AVX512F__
typedef float16 Lanes;
#define SAHL_STORE_LANES(v, i, p) vstore16(v, i, p)
#else
typedef float8 Lanes;
#define SAHL_STORE_LANES(v, i, p) vstore8(v, i, p)
#endif
#define SAHL_CHAINS 10u  // that wait for nothing of each other: more than latency times units

/// `rounds` times x <- x m + a in each of SAHL_CHAINS chains. `out` takes a vector of up to sixteen a
/// work-item: without it the compiler would leave all out.
kernel void multiply_add(global float* out, const float m, const float a, const uint rounds) {
    Lanes x[SAHL_CHAINS];
#pragma unroll
    for (uint k = 0; k < SAHL_CHAINS; ++k) {
        x[k] = (Lanes)((float)k + (float)get_global_id(0));
    }
    const Lanes by = (Lanes)(m), plus = (Lanes)(a);
    for (uint round = 0; round < rounds; ++round) {
#pragma unroll
        for (uint k = 0; k < SAHL_CHAINS; ++k) {
            x[k] = fma(x[k], by, plus);
        }
    }
    Lanes sum = x[0];
#pragma unroll
    for (uint k = 1; k < SAHL_CHAINS; ++k) {
        sum += x[k];
    }
    SAHL_STORE_LANES(sum, get_global_id(0), out);
}

/// out[0]: floating-point operations of a round of a work-item.
kernel void flop_of_round(global uint* out) {
    out[0] = 2u * SAHL_CHAINS * (uint)(sizeof(Lanes) / sizeof(float));
}
