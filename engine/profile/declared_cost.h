// What a kernel's work costs in memory and arithmetic, as declared by who wrote it.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/render/visits.h"

namespace sahl {

/// All rays of a generation.
struct GenerationWork {
    std::uint64_t rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t children = 0;
    std::uint32_t lights = 0;  ///< of the scene
    std::uint32_t spp = 1;     ///< samples a pixel
    GenerationVisits visits;
};

struct DeclaredCost {
    std::uint64_t bytes = 0;  ///< loaded and stored, as if there were no cache
    std::uint64_t flop = 0;   ///< floating-point operations, see kernels/count_visits.h
};

/// Of `kernel` over the rays of one generation; of "intersect" over those that `intersect` counts.
DeclaredCost declared_cost(std::string_view kernel, const GenerationWork& work,
                           const IntersectVisits& intersect);

}  // namespace sahl
