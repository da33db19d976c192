// What rays visit in the trees, counted by kernels built for that and never timed.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sahl {

/// Sums over the rays of a kernel in a generation, see SAHL_COUNT_* in device_types.h.
struct KernelVisits {
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint64_t leaf_bytes = 0;
    std::uint64_t flop = 0;
};

struct IntersectVisits {
    KernelVisits visits{};
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;  ///< rays that meet something
};

struct GenerationVisits {
    std::map<std::string, IntersectVisits> intersect{};  ///< by the name of the way of traversal
    KernelVisits shadow{};
    std::uint64_t lit = 0;  ///< shadow rays that reach their light
    KernelVisits shade{};   ///< flop alone: shading visits no tree

    std::uint64_t hits() const {
        std::uint64_t sum = 0;
        for (const auto& [way, of_way] : intersect) sum += of_way.hits;
        return sum;
    }
};

/// Sums by pixel, over its samples, generations and lights, in the order of a film; 2^32 - 1 stands for
/// more, too. What is empty is not counted.
struct PixelVisits {
    std::vector<std::uint32_t> rays;  ///< and shadow rays
    std::vector<std::uint32_t> nodes;
};

}  // namespace sahl
