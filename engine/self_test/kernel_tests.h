// One test a kernel: what it left in the queues against the reference's answer to the same input.
#pragma once

#include <span>

#include "engine/oracle/oracle.h"
#include "engine/render/trace_aovs.h"
#include "engine/self_test/readback.h"
#include "engine/self_test/self_test.h"

namespace sahl::self_test {

/// Camera samples of a wave.
struct TestWave {
    Camera camera;
    RenderSettings settings;
    Crop crop;
};

/// Camera samples of every wave, as many as a batch holds: children that are more have to wait.
constexpr std::uint32_t samples_of_wave = 1008;

/// All kernels of waves but "describe", on every_feature().
SelfTestReport run_waves(Device& device, WavefrontKernels& kernels, std::span<const TestWave> waves);

/// What the kernels of one generation are given.
struct Generation {
    WaitingBatch in_work;
    bool spawn;
};

// Each launches a kernel, compares and says in `test` what it found; false: a wrong answer.

bool test_generate(KernelTest& test, Wavefront& wavefront, const TestWave& wave);
bool test_intersect(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                    const Generation& generation);
bool test_shade(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                const Generation& generation);
bool test_shadow(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                 const Generation& generation);
bool test_count_children(KernelTest& test, Wavefront& wavefront, const Generation& generation);
bool test_sum_children(KernelTest& test, Wavefront& wavefront, const Generation& generation);
/// Into batch 0 and, what it cannot hold, batch 1; `children` is how many there were.
bool test_compact(KernelTest& test, Wavefront& wavefront, const Generation& generation,
                  std::uint32_t& children);

bool test_describe(KernelTest& test, Wavefront& wavefront, Kernel& describe, const oracle::Oracle& reference,
                   const TestWave& wave);

}  // namespace sahl::self_test
