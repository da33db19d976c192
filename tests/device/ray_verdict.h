// What a kernel may answer to a ray, by the oracle.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/oracle/oracle.h"
#include "tests/device/random_shapes.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {

/// The oracle's answers to a ray and to rays that single precision may take it for.
struct Verdict {
    /// All answers name the same primitive (or none): a kernel has to as well.
    bool sure = false;
    std::uint32_t primitive = SAHL_NO_PRIMITIVE;
    std::uint32_t instance = 0;
    bool one_face = true;            ///< all of them on the same part of it (Crossing::part)
    double t_least = 0, t_most = 0;  ///< where sure: the answers' range, and `rounding` on either side
    oracle::Crossing crossing;       ///< of the ray itself, where it hits
    double rounding = 0;             ///< how far rays were moved, world units
};

/// Single precision tells rays apart only when they are further from each other than its rounding: the oracle
/// is asked for `ray` as it is, moved by up to `roundings` roundings along and across its direction, and
/// turned so that its two ends move to opposite sides. Not sure besides: where the ray passes that close to a
/// tip, past which moved rays could slip, and where it lies in the plane of a flat target that closely.
Verdict judge(const std::vector<oracle::PlacedShape>& shapes, const std::vector<Target>& targets,
              const TestRay& ray, double roundings);

}  // namespace sahl::tests
