// One cell of the comparison: the same rays through the same scene on both sides, in turn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/differences.h"
#include "bench/embree_tracer.h"
#include "bench/rays.h"
#include "bench/sahl_tracer.h"
#include "bench/scenes.h"
#include "bench/statistics.h"

namespace sahl::bench {

/// One way to trace the rays: its name and the seconds that each repetition took.
struct Runs {
    std::string name;
    std::vector<double> seconds;
};

/// Embree's trees over one scene, and what their geometry is.
struct EmbreeSide {
    std::string geometry;  ///< "triangles", "spheres", "user geometry"
    RTCScene fast;         ///< Embree's defaults
    RTCScene robust;       ///< RTC_SCENE_FLAG_ROBUST; null: not measured
};

struct TraversalCell {
    std::string scene, rays, geometry;
    std::size_t count = 0;
    std::vector<Runs> sahl;    ///< every kernel
    std::vector<Runs> embree;  ///< the ways that are about as fast as the best
    std::vector<Runs> robust;
    Differences differences;  ///< to Embree's best way
    std::optional<std::size_t> robust_mismatches;
};

/// The run with the least median. Of at least one.
const Runs& best_of(const std::vector<Runs>& runs);

/// How the cells are measured.
struct Measurement {
    std::vector<std::string> kernels;  ///< of sahl_kernels
    int repetitions = 7;
    Clock clock = Clock::wall;
};

/// Measures both sides in turn and compares what they found; the caller has given `sahl` the scene. Throws
/// Error(internal) when two of Sahl's kernels do not agree bit by bit.
TraversalCell measure_cell(const BenchScene& scene, const RaySet& rays, SahlTracer& sahl,
                           const EmbreeSide& embree, const Measurement& how);

}  // namespace sahl::bench
