#include "tests/support/made_profile.h"

#include <vector>

#include "engine/profile/statistics.h"
#include "tests/host/profile/random_times.h"

namespace sahl::tests {
namespace {

using Json = nlohmann::ordered_json;

struct KernelModel {
    const char* name;
    double ms;     ///< in generation 0
    double bytes;  ///< a ray
    double flop;
};
constexpr KernelModel kernels[] = {
    {"generate", 0.6, 40, 60}, {"intersect", 10, 900, 2500},   {"shade", 4, 300, 400},
    {"shadow", 6, 600, 1500},  {"count_children", 0.05, 4, 1}, {"sum_children", 0.004, 1, 1},
    {"compact", 0.5, 60, 2},
};
constexpr int generations = 3;
constexpr double camera_rays = 65536;
constexpr double bandwidth = 30;  // GB/s
constexpr double peak = 200;      // GFLOP/s

std::string variant_of(const std::string& kernel, int generation) {
    if (kernel != "intersect" && kernel != "shadow") return "";
    return generation < 2 ? "packet" : "stream";
}

/// The figures of so many rays that took these times.
Json measures(double rays, double bytes, double flop, const std::vector<double>& samples) {
    const double ms = median(samples);
    const double mrays = rays / ms / 1000;
    return {{"launches", 1},
            {"rays_in", static_cast<std::uint64_t>(rays)},
            {"rays_out", static_cast<std::uint64_t>(rays / 2)},
            {"survival_percent", 50.0},
            {"ms_median", ms},
            {"ms_p95", quantile(samples, 0.95)},
            {"mrays_per_s", mrays},
            {"ns_per_ray", 1000 / mrays},
            {"bytes_per_ray", bytes},
            {"gb_per_s", bytes * mrays / 1000},
            {"bandwidth_percent", bytes * mrays / 10 / bandwidth},
            {"flop_per_ray", flop},
            {"gflop_per_s", flop * mrays / 1000},
            {"fma_percent", flop * mrays / 10 / peak},
            {"active_lanes", 0.97},
            {"node_visits_per_ray", nullptr},
            {"leaf_visits_per_ray", 2.5},
            {"queued_to_submit_ms", 0.02},
            {"submit_to_start_ms", 0.03},
            {"gap_ms", 0.01},
            {"wall_percent", 0.0},
            {"samples_ms", samples}};
}

void add(std::vector<double>& sums, const std::vector<double>& more) {
    sums.resize(more.size());
    for (std::size_t i = 0; i < more.size(); ++i) sums[i] += more[i];
}

Json breakdown(double wall, double busy) {
    const double idle = wall - busy;
    return {{"wall_ms", wall},
            {"device_busy_ms", busy},
            {"device_idle_ms", idle},
            {"exposed", {{"accumulate", 0.7 * idle}, {"encode", 0.3 * idle}}},
            {"unattributed_ms", 0.0}};
}

Json environment() {
    return {{"sahl", "0.1.0"},
            {"scene", "made.json"},
            {"scene_hash", "5ce0e"},
            {"kernel_hash", "6e4"},
            {"camera", "camera"},
            {"width", 256},
            {"height", 256},
            {"crop", nullptr},
            {"depth", generations - 1},
            {"spp", 1},
            {"seed", 0},
            {"ray_budget", 65536},
            {"device", "made"},
            {"build_quality", "high"},
            {"platform", "Portable </script> Language"},
            {"driver", "3.1"},
            {"device_version", "OpenCL 3"},
            {"cpu", "made <b>CPU</b>"},
            {"threads", 2},
            {"clock_uncertainty_ns", 90.0},
            {"overhead_percent", 0.3},
            {"overhead_low_percent", -0.1},
            {"overhead_high_percent", 0.8},
            {"warm_up", 2}};
}

}  // namespace

Json made_profile(const MadeProfile& made) {
    RandomTimes random(made.seed);
    Json profile{{"version", 1},           {"wall_ms", 0},
                 {"unattributed_ms", 0.0}, {"compiles_during_render", 0},
                 {"compiles_in_setup", 7}, {"environment", environment()}};
    profile["calibration"] = {{"bandwidth_gb_per_s", bandwidth}, {"fma_gflop_per_s", peak}, {"cached", true}};
    profile["setup"] = breakdown(250, 10);
    std::vector<double> busy;
    std::vector<std::vector<double>> by_generation(generations);
    Json rows = Json::array();
    Json kernel_totals = Json::array();
    for (const KernelModel& kernel : kernels) {
        const auto factor = made.factors.find(kernel.name);
        std::map<std::string, std::vector<double>> by_variant;
        for (int generation = 0; generation < generations; ++generation) {
            const std::string name = kernel.name;
            if (name == "generate" && generation > 0) continue;
            const double ms =
                kernel.ms / (1 << generation) * (factor == made.factors.end() ? 1 : factor->second);
            std::vector<double> samples;
            for (int i = 0; i < made.repetitions; ++i) samples.push_back(random.time(ms, made.noise));
            Json row{{"kernel", name}, {"variant", variant_of(name, generation)}, {"generation", generation}};
            row.update(measures(camera_rays / (1 << generation), kernel.bytes, kernel.flop, samples));
            rows.push_back(row);
            add(busy, samples);
            add(by_generation[static_cast<std::size_t>(generation)], samples);
            add(by_variant[variant_of(name, generation)], samples);
        }
        for (const auto& [variant, samples] : by_variant) {
            Json total{{"kernel", kernel.name}, {"variant", variant}};
            total.update(measures(camera_rays, kernel.bytes, kernel.flop, samples));
            kernel_totals.push_back(total);
        }
    }
    Json repetitions = Json::array();
    std::vector<double> walls;
    for (const double ms : busy) {
        walls.push_back(1.1 * ms);
        Json repetition = breakdown(walls.back(), ms);
        repetition["outlier"] = false;
        repetitions.push_back(repetition);
    }
    const double wall = median(walls);
    profile["wall_ms"] = wall;
    profile["repetitions"] = repetitions;
    Json generation_totals = Json::array();
    for (int generation = 0; generation < generations; ++generation) {
        Json total{{"generation", generation}};
        total.update(measures(camera_rays / (1 << generation), 0, 0,
                              by_generation[static_cast<std::size_t>(generation)]));
        generation_totals.push_back(total);
    }
    for (Json* list : {&rows, &kernel_totals, &generation_totals}) {
        for (Json& row : *list) row["wall_percent"] = 100 * row["ms_median"].get<double>() / wall;
    }
    profile["rows"] = rows;
    profile["kernel_totals"] = kernel_totals;
    profile["generation_totals"] = generation_totals;
    profile["host_steps"] = Json::array();
    for (const char* name : {"accumulate", "encode"}) {
        profile["host_steps"].push_back({{"name", name},
                                         {"phase", "frame"},
                                         {"calls", 3},
                                         {"ms_total", 1.5},
                                         {"ms_exposed", 0.5},
                                         {"samples_ms", std::vector<double>(busy.size(), 1.5)}});
    }
    return profile;
}

}  // namespace sahl::tests
