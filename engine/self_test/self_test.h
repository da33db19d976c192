// A device's kernels against the host's own answers in double precision.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/device/device.h"

namespace sahl {

/// What was found of one kernel.
struct KernelTest {
    std::string kernel;
    std::uint64_t checked = 0;  ///< rays, shadings or numbers compared
    double worst = 0;           ///< largest difference, relative above 1 and absolute below
    double allowed = 0;         ///< what it may be; 0 for kernels that count and move
    std::string failure{};      ///< the first wrong answer: ray, expected, found; empty: all were right
};

struct SelfTestReport {
    /// In the order of a wave. The test ends at the first wrong answer, for kernels work on what others
    /// give them: at most one has failed.
    std::vector<KernelTest> kernels;

    /// The kernel that failed; null if all passed.
    const KernelTest* failed() const;
};

/// Renders a small scene that has everything a scene can have, and compares what each kernel makes of
/// each ray with a brute-force ray tracer on the host. Renderer does so by itself before the first use of
/// a device, driver, processor and set of kernels, and remembers in the program cache what has passed.
/// Throws Error(device) and Error(memory) where the kernels cannot be built or run at all.
SelfTestReport run_self_test(Device& device);

}  // namespace sahl
