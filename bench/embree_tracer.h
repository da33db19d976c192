// Rays through Embree, by each of its ways to hand them over.
#pragma once

#include <embree3/rtcore.h>

#include <span>
#include <string>
#include <vector>

#include "bench/rays.h"
#include "bench/statistics.h"
#include "engine/device/memory.h"

namespace sahl::bench {

/// A way to hand rays over.
struct EmbreeApi {
    const char* name;          ///< what follows rtcIntersect or rtcOccluded
    unsigned int width;        ///< rays of a packet: structures of arrays this wide
    bool is_stream = false;    ///< many packets (for a width of 1 rays) a call
    bool is_coherent = false;  ///< the context says that rays are
};

/// Single rays, packets of 8 and 16, streams of rays and of packets of 16; all but the first told that rays
/// are coherent and not.
std::span<const EmbreeApi> embree_apis();

/// "rtcIntersect16 coherent"
std::string api_name(const EmbreeApi& api, bool occlusion);

/// A set of rays in Embree's structures. One for all ways of a width.
class EmbreeRays {
public:
    /// Keeps a reference to `rays`.
    EmbreeRays(MemoryAccountant& accountant, const RaySet& rays, unsigned int width);

    /// Traces all rays on all cores; returns the seconds it took, from rays that are ready.
    /// `api`: of the same width.
    double trace(RTCScene scene, const EmbreeApi& api, Clock clock = Clock::wall);

    /// What the last trace() found.
    std::vector<RayHit> hits() const;

private:
    RTCRayN* packet_rays(std::size_t packet) const;
    RTCHitN* packet_hits(std::size_t packet) const;
    void make_ready();

    const RaySet& rays_;
    unsigned int width_;
    std::size_t packets_;
    std::size_t packet_bytes_;
    HostMemory memory_;
};

}  // namespace sahl::bench
