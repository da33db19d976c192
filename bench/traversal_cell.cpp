#include "bench/traversal_cell.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "engine/core/error.h"

namespace sahl::bench {
namespace {

/// Ways of Embree's that take longer than the fastest by this factor in a first round are not timed further.
constexpr double worth_timing = 1.25;

/// Rays laid out once for each width.
using EmbreeLayouts = std::map<unsigned int, EmbreeRays>;

/// A way through one of Embree's scenes.
struct EmbreeWay {
    const EmbreeApi* api;
    RTCScene scene;

    double trace(EmbreeLayouts& layouts, Clock clock) const {
        return layouts.at(api->width).trace(scene, *api, clock);
    }
};

std::vector<EmbreeWay> fastest_ways(EmbreeLayouts& layouts, RTCScene scene, Clock clock) {
    std::vector<EmbreeWay> ways;
    std::vector<double> seconds;
    for (const EmbreeApi& api : embree_apis()) {
        ways.push_back({&api, scene});
        seconds.push_back(ways.back().trace(layouts, clock));
        for (int i = 0; i < 2; ++i)
            seconds.back() = std::min(seconds.back(), ways.back().trace(layouts, clock));
    }
    const double limit = worth_timing * *std::min_element(seconds.begin(), seconds.end());
    std::vector<EmbreeWay> fastest;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        if (seconds[i] <= limit) fastest.push_back(ways[i]);
    }
    return fastest;
}

std::vector<Runs> runs_of(const std::vector<EmbreeWay>& ways, bool occlusion) {
    std::vector<Runs> runs;
    for (const EmbreeWay& way : ways) runs.push_back({api_name(*way.api, occlusion), {}});
    return runs;
}

/// Embree's hits by the way that was best.
std::vector<RayHit> best_hits(const std::vector<EmbreeWay>& ways, const std::vector<Runs>& runs,
                              EmbreeLayouts& layouts) {
    const EmbreeWay& way = ways[static_cast<std::size_t>(&best_of(runs) - runs.data())];
    way.trace(layouts, Clock::wall);
    return layouts.at(way.api->width).hits();
}

/// Launches each kernel until PoCL has compiled it and its memory is in place.
void warm_up(SahlTracer& sahl, const std::vector<std::string>& kernels, const RaySet& rays) {
    std::vector<std::uint32_t> first;
    for (const std::string& kernel : kernels) {
        for (int i = 0; i < 2; ++i) sahl.trace(kernel);
        if (first.empty()) first = sahl.record();
        if (sahl.record() != first)
            throw Error(ExitCode::internal,
                        fmt::format("kernels {} and {} do not agree bit by bit on {} rays", kernels.front(),
                                    kernel, rays.kind));
    }
}

/// What both sides name as the closest hits of occlusion rays that differ; of other rays the hits themselves.
Differences explain(const Scene& scene, const RaySet& rays, const std::vector<std::size_t>& places,
                    const std::vector<RayHit>& sahl_hits, const std::vector<RayHit>& embree_hits,
                    SahlTracer& sahl, const std::string& kernel, RTCScene embree) {
    Differences differences;
    RaySet closest = select_rays(rays, places);
    closest.occlusion = false;
    std::vector<RayHit> sahl_named, embree_named;
    if (rays.occlusion && !places.empty()) {
        EmbreeRays layout(sahl.device().memory(), closest, 1);
        layout.trace(embree, embree_apis().front());
        embree_named = layout.hits();
        sahl.set_rays(closest);
        sahl.trace(kernel);
        sahl_named = sahl.hits();
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        const RayHit &a = sahl_hits[places[k]], &b = embree_hits[places[k]];
        add_difference(differences, scene, rays, places[k], {a, rays.occlusion ? sahl_named[k] : a},
                       {b, rays.occlusion ? embree_named[k] : b});
    }
    return differences;
}

}  // namespace

const Runs& best_of(const std::vector<Runs>& runs) {
    return *std::min_element(runs.begin(), runs.end(), [](const Runs& a, const Runs& b) {
        return spread_of(a.seconds).median < spread_of(b.seconds).median;
    });
}

TraversalCell measure_cell(const BenchScene& scene, const RaySet& rays, SahlTracer& sahl,
                           const EmbreeSide& embree, const Measurement& how) {
    TraversalCell cell{scene.name, rays.kind, embree.geometry, rays.size(), {}, {}, {}, {}, {}};
    EmbreeLayouts layouts;
    for (const EmbreeApi& api : embree_apis())
        layouts.try_emplace(api.width, sahl.device().memory(), rays, api.width);
    sahl.set_rays(rays);
    warm_up(sahl, how.kernels, rays);

    const std::vector<EmbreeWay> fast = fastest_ways(layouts, embree.fast, how.clock);
    const std::vector<EmbreeWay> robust =
        embree.robust != nullptr ? fastest_ways(layouts, embree.robust, how.clock) : std::vector<EmbreeWay>{};
    cell.embree = runs_of(fast, rays.occlusion);
    cell.robust = runs_of(robust, rays.occlusion);
    for (const std::string& kernel : how.kernels) cell.sahl.push_back({kernel, {}});
    for (int repetition = 0; repetition < how.repetitions; ++repetition) {
        for (std::size_t i = 0; i < fast.size(); ++i)
            cell.embree[i].seconds.push_back(fast[i].trace(layouts, how.clock));
        for (std::size_t i = 0; i < how.kernels.size(); ++i)
            cell.sahl[i].seconds.push_back(sahl.trace(how.kernels[i], how.clock));
        for (std::size_t i = 0; i < robust.size(); ++i)
            cell.robust[i].seconds.push_back(robust[i].trace(layouts, how.clock));
    }

    const std::vector<RayHit> sahl_hits = sahl.hits();
    const std::vector<RayHit> embree_hits = best_hits(fast, cell.embree, layouts);
    if (!robust.empty())
        cell.robust_mismatches =
            differing_rays(rays, sahl_hits, best_hits(robust, cell.robust, layouts)).size();
    cell.differences =
        explain(scene.scene, rays, differing_rays(rays, sahl_hits, embree_hits), sahl_hits, embree_hits, sahl,
                how.kernels.front(), embree.robust != nullptr ? embree.robust : embree.fast);
    return cell;
}

}  // namespace sahl::bench
