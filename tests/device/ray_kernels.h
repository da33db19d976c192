// The test kernels that RayTracer runs beside the engine's own.
#pragma once

namespace sahl::tests {

/// OpenCL C for KernelRunner: kernels/intersect.cl, shade.cl and shadow.cl, then kernels that call the
/// functions behind them.
extern const char* const ray_kernels;

}  // namespace sahl::tests
