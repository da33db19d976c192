#include "engine/profile/profile_csv.h"

#include <fmt/format.h>

namespace sahl {
namespace {

constexpr const char* line_end = "\r\n";

template <class T>
std::string text_of(const std::optional<T>& value) {
    return value ? fmt::format("{}", *value) : "";
}

std::string line_of(const ProfileRow& row) {
    const ProfileMeasures& m = row.measures;
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}{}",
                       row.kernel, row.variant, text_of(row.generation), m.launches, m.rays_in,
                       text_of(m.rays_out), text_of(m.survival_percent), m.ms_median, m.ms_p95,
                       text_of(m.mrays_per_s), text_of(m.ns_per_ray), text_of(m.bytes_per_ray),
                       text_of(m.gb_per_s), text_of(m.bandwidth_percent), text_of(m.flop_per_ray),
                       text_of(m.gflop_per_s), text_of(m.fma_percent), m.active_lanes,
                       text_of(m.node_visits_per_ray), text_of(m.leaf_visits_per_ray), m.queued_to_submit_ms,
                       m.submit_to_start_ms, m.gap_ms, m.wall_percent, line_end);
}

}  // namespace

std::string profile_csv(const Profile& profile) {
    std::string text = std::string("kernel,variant,generation,launches,rays_in,rays_out,survival_percent,") +
                       "ms_median,ms_p95,mrays_per_s,ns_per_ray,bytes_per_ray,gb_per_s,bandwidth_percent," +
                       "flop_per_ray,gflop_per_s,fma_percent,active_lanes,node_visits_per_ray," +
                       "leaf_visits_per_ray,queued_to_submit_ms,submit_to_start_ms,gap_ms,wall_percent" +
                       line_end;
    for (const ProfileRow& row : profile.rows) text += line_of(row);
    return text;
}

}  // namespace sahl
