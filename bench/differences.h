// Where the two sides disagree, and who is right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/rays.h"
#include "engine/scene/scene.h"

namespace sahl::bench {

/// Counts of rays. The second group judges the same rays by the primitives that the two sides name, in
/// double precision.
struct Differences {
    std::uint64_t sahl_misses = 0;    ///< what Embree hits
    std::uint64_t embree_misses = 0;  ///< what Sahl hits
    std::uint64_t distances = 0;      ///< both hit, at distances that differ

    std::uint64_t at_outline = 0;  ///< the ray passes a named primitive's outline within 1e-5 of its size
    std::uint64_t rounding = 0;    ///< both are right but for rounding of coordinates, which a short t shows
    std::uint64_t sahl_right = 0;
    std::uint64_t embree_right = 0;
    std::uint64_t both_wrong = 0;

    std::uint64_t rays() const { return sahl_misses + embree_misses + distances; }
    Differences& operator+=(const Differences& other);
};

/// The rays of which the sides say something else: hit or not, or t by more than 1e-4 of it.
std::vector<std::size_t> differing_rays(const RaySet& rays, const std::vector<RayHit>& sahl,
                                        const std::vector<RayHit>& embree);

/// What one side says of a ray, and a primitive that it names: for an occlusion ray what it finds as closest
/// hit.
struct Answer {
    RayHit hit;
    RayHit named;
};

/// Adds one differing ray, number `i` of `rays`.
void add_difference(Differences& differences, const Scene& scene, const RaySet& rays, std::size_t i,
                    const Answer& sahl, const Answer& embree);

}  // namespace sahl::bench
