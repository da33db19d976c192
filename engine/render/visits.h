// What rays visit in the trees, counted by kernels built for that and never timed.
#pragma once

#include <cstdint>

namespace sahl {

/// Sums over the rays of a kernel in a generation, see SAHL_COUNT_* in device_types.h.
struct KernelVisits {
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint64_t leaf_bytes = 0;
    std::uint64_t flop = 0;
};

struct GenerationVisits {
    KernelVisits intersect;
    KernelVisits shadow;
    std::uint64_t hits = 0;  ///< rays that meet something
    std::uint64_t lit = 0;   ///< shadow rays that reach their light
};

}  // namespace sahl
