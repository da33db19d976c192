#include "bench/embree_tracer.h"

#include <algorithm>
#include <iterator>

#include "bench/all_cores.h"

namespace sahl::bench {
namespace {

/// Rays that a core takes at a time: whole packets, and what suits a stream.
constexpr std::size_t chunk = 1024;

/// `count` packets of `bytes` each, one call a packet.
template <unsigned int width>
void trace_packets(RTCScene scene, RTCIntersectContext* context, std::byte* packets, std::size_t count,
                   std::size_t bytes, bool occlusion) {
    alignas(64) int valid[16];
    std::fill(std::begin(valid), std::end(valid), -1);
    for (void* packet = packets; packet != packets + count * bytes;
         packet = static_cast<std::byte*>(packet) + bytes) {
        if constexpr (width == 1) {
            if (occlusion) {
                rtcOccluded1(scene, context, static_cast<RTCRay*>(packet));
            } else {
                rtcIntersect1(scene, context, static_cast<RTCRayHit*>(packet));
            }
        } else if constexpr (width == 8) {
            if (occlusion) {
                rtcOccluded8(valid, scene, context, static_cast<RTCRay8*>(packet));
            } else {
                rtcIntersect8(valid, scene, context, static_cast<RTCRayHit8*>(packet));
            }
        } else {
            if (occlusion) {
                rtcOccluded16(valid, scene, context, static_cast<RTCRay16*>(packet));
            } else {
                rtcIntersect16(valid, scene, context, static_cast<RTCRayHit16*>(packet));
            }
        }
    }
}

/// The same in one call.
void trace_stream(RTCScene scene, RTCIntersectContext* context, std::byte* packets, std::size_t count,
                  std::size_t bytes, unsigned int width, bool occlusion) {
    const auto size = static_cast<unsigned int>(count);
    if (width == 1 && occlusion) {
        rtcOccluded1M(scene, context, reinterpret_cast<RTCRay*>(packets), size, bytes);
    } else if (width == 1) {
        rtcIntersect1M(scene, context, reinterpret_cast<RTCRayHit*>(packets), size, bytes);
    } else if (occlusion) {
        rtcOccludedNM(scene, context, reinterpret_cast<RTCRayN*>(packets), width, size, bytes);
    } else {
        rtcIntersectNM(scene, context, reinterpret_cast<RTCRayHitN*>(packets), width, size, bytes);
    }
}

/// Of one ray in a structure of any width.
constexpr std::size_t ray_bytes = 12 * sizeof(float);
constexpr std::size_t hit_bytes = 8 * sizeof(float);
static_assert(sizeof(RTCRay16) == 16 * ray_bytes && sizeof(RTCRayHit16) == 16 * (ray_bytes + hit_bytes));
static_assert(sizeof(RTCRay) == ray_bytes && sizeof(RTCRayHit) == ray_bytes + hit_bytes);

}  // namespace

std::span<const EmbreeApi> embree_apis() {
    static constexpr EmbreeApi apis[] = {
        {"1", 1},
        {"8", 8, false, false},
        {"8", 8, false, true},
        {"16", 16, false, false},
        {"16", 16, false, true},
        {"1M", 1, true, false},
        {"1M", 1, true, true},
        {"NM16", 16, true, false},
        {"NM16", 16, true, true},
    };
    return apis;
}

std::string api_name(const EmbreeApi& api, bool occlusion) {
    return std::string(occlusion ? "rtcOccluded" : "rtcIntersect") + api.name +
           (api.is_coherent ? " coherent" : "");
}

EmbreeRays::EmbreeRays(MemoryAccountant& accountant, const RaySet& rays, unsigned int width)
    : rays_(rays),
      width_(width),
      packets_((rays.size() + width - 1) / width),
      packet_bytes_(width * (rays.occlusion ? ray_bytes : ray_bytes + hit_bytes)),
      memory_(accountant, packets_ * packet_bytes_, "rays for Embree") {}

RTCRayN* EmbreeRays::packet_rays(std::size_t packet) const {
    return reinterpret_cast<RTCRayN*>(static_cast<std::byte*>(memory_.data()) + packet * packet_bytes_);
}

RTCHitN* EmbreeRays::packet_hits(std::size_t packet) const {
    return RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(packet_rays(packet)), width_);
}

void EmbreeRays::make_ready() {
    for_chunks(packets_, chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t packet = begin; packet < end; ++packet) {
            RTCRayN* rays = packet_rays(packet);
            for (unsigned int lane = 0; lane < width_; ++lane) {
                const std::size_t i = packet * width_ + lane;
                const bool is_ray = i < rays_.size();  // the last packet's other lanes have none
                const glm::vec3 origin = is_ray ? rays_.origins[i] : glm::vec3(0);
                const glm::vec3 direction = is_ray ? rays_.directions[i] : glm::vec3(1);
                RTCRayN_org_x(rays, width_, lane) = origin.x;
                RTCRayN_org_y(rays, width_, lane) = origin.y;
                RTCRayN_org_z(rays, width_, lane) = origin.z;
                RTCRayN_dir_x(rays, width_, lane) = direction.x;
                RTCRayN_dir_y(rays, width_, lane) = direction.y;
                RTCRayN_dir_z(rays, width_, lane) = direction.z;
                RTCRayN_tnear(rays, width_, lane) = 0;
                RTCRayN_tfar(rays, width_, lane) = is_ray ? rays_.t_max : -1;
                RTCRayN_time(rays, width_, lane) = 0;
                RTCRayN_mask(rays, width_, lane) = 0xffffffffU;
                RTCRayN_id(rays, width_, lane) = 0;
                RTCRayN_flags(rays, width_, lane) = 0;
                if (rays_.occlusion) continue;
                RTCHitN_geomID(packet_hits(packet), width_, lane) = RTC_INVALID_GEOMETRY_ID;
                RTCHitN_instID(packet_hits(packet), width_, lane, 0) = RTC_INVALID_GEOMETRY_ID;
            }
        }
    });
}

double EmbreeRays::trace(RTCScene scene, const EmbreeApi& api, Clock clock) {
    make_ready();
    const double start = seconds_now(clock);
    for_chunks(packets_, chunk / width_, [&](std::size_t begin, std::size_t end) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            api.is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        std::byte* packets = reinterpret_cast<std::byte*>(packet_rays(begin));
        const auto trace_one_by_one = width_ == 1   ? trace_packets<1>
                                      : width_ == 8 ? trace_packets<8>
                                                    : trace_packets<16>;
        if (api.is_stream) {
            trace_stream(scene, &context, packets, end - begin, packet_bytes_, width_, rays_.occlusion);
        } else {
            trace_one_by_one(scene, &context, packets, end - begin, packet_bytes_, rays_.occlusion);
        }
    });
    return seconds_now(clock) - start;
}

std::vector<RayHit> EmbreeRays::hits() const {
    std::vector<RayHit> hits(rays_.size());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const std::size_t packet = i / width_;
        const auto lane = static_cast<unsigned int>(i % width_);
        hits[i].t = RTCRayN_tfar(packet_rays(packet), width_, lane);
        if (rays_.occlusion) {
            hits[i].hit = hits[i].t < 0;
        } else {
            hits[i].hit = RTCHitN_geomID(packet_hits(packet), width_, lane) != RTC_INVALID_GEOMETRY_ID;
            hits[i].primitive = RTCHitN_primID(packet_hits(packet), width_, lane);
        }
    }
    return hits;
}

}  // namespace sahl::bench
