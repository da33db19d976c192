// The test kernels that RayTracer runs beside the engine's own.
#pragma once

namespace sahl::tests {

/// OpenCL C for KernelRunner: the kernels of intersect_*.cl, shade.cl and shadow_*.cl, then kernels that call
/// the functions behind them.
extern const char* const ray_kernels;

}  // namespace sahl::tests
