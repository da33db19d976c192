// What rays visit in the trees, counted by kernels built for that and never timed.
#pragma once

#include <cstdint>
#include <vector>

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
    KernelVisits shade{};    ///< flop alone: shading visits no tree
};

/// Sums by pixel, over its samples, generations and lights, in the order of a film; 2^32 - 1 stands for
/// more, too. What is empty is not counted.
struct PixelVisits {
    std::vector<std::uint32_t> rays;  ///< and shadow rays
    std::vector<std::uint32_t> nodes;
};

}  // namespace sahl
