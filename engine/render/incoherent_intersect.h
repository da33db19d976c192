// The kernel for batches whose rays go any way: its program is built, which takes as long as some hundred
// thousand rays do, once an image has enough of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/device/program.h"
#include "engine/render/launches.h"

namespace sahl {

/// Whether the children of a batch keep together, from its totals (SAHL_TOTAL_*).
bool are_coherent(std::span<const std::uint32_t> totals);

class IncoherentIntersect {
public:
    /// `others`, of `program`, are what waves are traced by beside it; both outlive this.
    IncoherentIntersect(Device& device, Program& program, WavefrontKernels& others);

    void begin_image() { rays_ = 0; }

    /// To intersect `rays` rays of the image by: as long as they are too few, or where the others are not
    /// optimized either, the kernel of the others. Tests the kernel before its first use. Throws as Program
    /// and test_before_first_use.
    TracingKernel& kernel_for(std::uint32_t rays);

    /// Builds it, if there is one, without waiting for rays; `counting`: one that counts visits and is not
    /// tested.
    void build(bool counting);
    bool is_built() const { return kernel_.has_value(); }

    /// See Program::store_binary.
    void store_binary();

private:
    Device& device_;
    Program& program_of_others_;
    WavefrontKernels& others_;
    std::uint64_t rays_ = 0;  ///< of the image so far
    std::optional<Program> program_{};
    std::optional<TracingKernel> kernel_{};
};

}  // namespace sahl
