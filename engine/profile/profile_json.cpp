#include "engine/profile/profile_json.h"

#include <nlohmann/json.hpp>

namespace sahl {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format_version = 1;

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json environment_json(const ProfileEnvironment& e) {
    return {{"sahl", e.sahl},
            {"scene", e.scene},
            {"scene_hash", e.scene_hash},
            {"kernel_hash", e.kernel_hash},
            {"camera", e.camera},
            {"width", e.width},
            {"height", e.height},
            {"crop", or_null(e.crop)},
            {"depth", e.depth},
            {"spp", e.spp},
            {"seed", e.seed},
            {"ray_budget", e.ray_budget},
            {"build_quality", e.build_quality},
            {"device", e.device},
            {"platform", e.platform},
            {"device_version", e.device_version},
            {"driver", e.driver},
            {"cpu", e.cpu},
            {"threads", e.threads},
            {"clock_uncertainty_ns", e.clock_uncertainty_ns},
            {"overhead_percent", e.overhead_percent},
            {"overhead_low_percent", e.overhead_low_percent},
            {"overhead_high_percent", e.overhead_high_percent},
            {"warm_up", e.warm_up}};
}

Json breakdown_json(const TimeBreakdown& time) {
    return {{"wall_ms", time.wall_ms},
            {"device_busy_ms", time.device_busy_ms},
            {"device_idle_ms", time.device_idle_ms},
            {"exposed", Json(time.exposed_ms)},
            {"unattributed_ms", time.unattributed_ms}};
}

Json row_json(const ProfileRow& row, bool of_kernel, bool of_generation) {
    const ProfileMeasures& m = row.measures;
    Json json = Json::object();
    if (of_kernel) {
        json["kernel"] = row.kernel;
        json["variant"] = row.variant;
    }
    if (of_generation) json["generation"] = or_null(row.generation);
    const Json measures{{"launches", m.launches},
                        {"rays_in", m.rays_in},
                        {"rays_out", or_null(m.rays_out)},
                        {"survival_percent", or_null(m.survival_percent)},
                        {"ms_median", m.ms_median},
                        {"ms_p95", m.ms_p95},
                        {"mrays_per_s", or_null(m.mrays_per_s)},
                        {"ns_per_ray", or_null(m.ns_per_ray)},
                        {"bytes_per_ray", or_null(m.bytes_per_ray)},
                        {"gb_per_s", or_null(m.gb_per_s)},
                        {"bandwidth_percent", or_null(m.bandwidth_percent)},
                        {"flop_per_ray", or_null(m.flop_per_ray)},
                        {"gflop_per_s", or_null(m.gflop_per_s)},
                        {"fma_percent", or_null(m.fma_percent)},
                        {"active_lanes", m.active_lanes},
                        {"node_visits_per_ray", or_null(m.node_visits_per_ray)},
                        {"leaf_visits_per_ray", or_null(m.leaf_visits_per_ray)},
                        {"queued_to_submit_ms", m.queued_to_submit_ms},
                        {"submit_to_start_ms", m.submit_to_start_ms},
                        {"gap_ms", m.gap_ms},
                        {"wall_percent", m.wall_percent},
                        {"samples_ms", m.samples_ms}};
    json.insert(measures.begin(), measures.end());
    return json;
}

Json rows_json(const std::vector<ProfileRow>& rows, bool of_kernels, bool of_generations) {
    Json json = Json::array();
    for (const ProfileRow& row : rows) json.push_back(row_json(row, of_kernels, of_generations));
    return json;
}

Json repetitions_json(const std::vector<ProfileRepetition>& repetitions) {
    Json json = Json::array();
    for (const ProfileRepetition& repetition : repetitions) {
        json.push_back(breakdown_json(repetition.time));
        json.back()["outlier"] = repetition.outlier;
    }
    return json;
}

Json host_steps_json(const std::vector<ProfileHostStep>& steps) {
    Json json = Json::array();
    for (const ProfileHostStep& step : steps) {
        json.push_back({{"name", step.name},
                        {"phase", step.phase == ProfilePhase::setup ? "setup" : "frame"},
                        {"calls", step.calls},
                        {"ms_total", step.ms_total},
                        {"ms_exposed", step.ms_exposed},
                        {"samples_ms", step.samples_ms}});
    }
    return json;
}

}  // namespace

std::string profile_json(const Profile& profile) {
    const Json json{{"version", format_version},
                    {"wall_ms", profile.wall_ms},
                    {"unattributed_ms", profile.unattributed_ms},
                    {"compiles_during_render", profile.compiles_during_render},
                    {"compiles_in_setup", profile.compiles_in_setup},
                    {"environment", environment_json(profile.environment)},
                    {"calibration",
                     {{"bandwidth_gb_per_s", profile.calibration.bandwidth_gb_per_s},
                      {"fma_gflop_per_s", profile.calibration.fma_gflop_per_s},
                      {"cached", profile.calibration.cached}}},
                    {"setup", breakdown_json(profile.setup)},
                    {"repetitions", repetitions_json(profile.repetitions)},
                    {"rows", rows_json(profile.rows, true, true)},
                    {"kernel_totals", rows_json(profile.kernel_totals, true, false)},
                    {"generation_totals", rows_json(profile.generation_totals, false, true)},
                    {"host_steps", host_steps_json(profile.host_steps)}};
    // A file name need not be UTF-8.
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace sahl
