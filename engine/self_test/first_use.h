// The self-test by itself, before the first use of kernels.
#pragma once

#include "engine/device/program.h"
#include "engine/render/launches.h"

namespace sahl {

/// Each tests the kernels of `program` unless they have passed before, in this process or by the program
/// cache, and remembers that they did.
/// Throws Error(device) naming device, driver, kernel, ray and difference when an answer is wrong.
void test_before_first_use(Device& device, Program& program, WavefrontKernels& kernels);
void test_before_first_use(Device& device, Program& program, Kernel& describe, WavefrontKernels& kernels);

/// What the process of a CompileHelper does: compiles what build_wavefront_program() leaves to it, and ends.
[[noreturn]] void compile_for_another_process(const DeviceOptions& options);

}  // namespace sahl
