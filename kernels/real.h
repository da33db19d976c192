// The precision of shading geometry.
//
// Rays are traced in single precision, but positions, normals and directions of the ray tree are
// computed in double precision and handed on as a float and what it lacks: each bounce off a small
// sphere magnifies an error in the ray a hundredfold, and single precision shows in the image
// after three. A device without doubles does with floats.
#ifndef SAHL_REAL_H
#define SAHL_REAL_H

#include "kernels/math.h"

#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
typedef double3 real3;
#define convert_real3 convert_double3
#else
typedef float real;
typedef float3 real3;
#define convert_real3 convert_float3
#endif

static inline real dot3_real(real3 a, real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline float3 round3(real3 v) { return convert_float3(v); }

/// Three floats and, behind them, the three that they lack.
static inline real3 load3_real(const global float* p) {
    return convert_real3(load3(p)) + convert_real3(load3(p + 3));
}

#endif
