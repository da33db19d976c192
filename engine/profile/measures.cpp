#include "engine/profile/measures.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/profile/declared_cost.h"
#include "engine/profile/statistics.h"
#include "engine/profile/timeline.h"

namespace sahl {
namespace {

constexpr std::array<std::string_view, 7> pipeline{"generate",       "intersect",    "shade",  "shadow",
                                                   "count_children", "sum_children", "compact"};

/// A sum that is unknown when a part of it is.
class OptionalSum {
public:
    void add(std::optional<std::uint64_t> part) {
        if (!part) unknown_ = true;
        sum_ += part.value_or(0);
    }
    std::optional<std::uint64_t> value() const {
        return unknown_ ? std::nullopt : std::optional<std::uint64_t>(sum_);
    }

private:
    std::uint64_t sum_ = 0;
    bool unknown_ = false;
};

/// Of some launches in each frame.
struct Sums {
    explicit Sums(std::size_t frames)
        : run_ns(frames), queued_ns(frames), submitted_ns(frames), gap_ns(frames) {}

    std::uint64_t launches = 0, items = 0, lanes = 0;  // of the first frame
    std::uint64_t rays_in = 0;
    OptionalSum rays_out, bytes, flop, nodes, leaves;
    std::vector<std::uint64_t> run_ns, queued_ns, submitted_ns, gap_ns;  // by frame

    void add(const Sums& other) {
        launches += other.launches;
        items += other.items;
        lanes += other.lanes;
        rays_in += other.rays_in;
        rays_out.add(other.rays_out.value());
        bytes.add(other.bytes.value());
        flop.add(other.flop.value());
        add_times(other);
    }
    /// Visits are those of kernels that have any.
    void add_visits(const Sums& other) {
        nodes.add(other.nodes.value());
        leaves.add(other.leaves.value());
    }
    void add_times(const Sums& other) {
        const auto add_each = [](auto& to, const auto& from) {
            for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
        };
        add_each(run_ns, other.run_ns);
        add_each(queued_ns, other.queued_ns);
        add_each(submitted_ns, other.submitted_ns);
        add_each(gap_ns, other.gap_ns);
    }
};

/// Generation, place in the pipeline, variant: rows in this order.
using RowKey = std::tuple<std::uint32_t, std::size_t, std::string>;

RowKey key_of(const LaunchRecord& launch) {
    auto [kernel, variant] = split_name(launch.kernel);
    const auto place = std::find(pipeline.begin(), pipeline.end(), kernel) - pipeline.begin();
    return {launch.generation, static_cast<std::size_t>(place), std::move(variant)};
}

std::map<RowKey, Sums> sum_launches(const Measurement& measurement) {
    const std::size_t count = measurement.frames.size();
    std::map<RowKey, Sums> rows;
    for (std::size_t frame = 0; frame < count; ++frame) {
        std::uint64_t idle_since = measurement.frames[frame].begin_ns;
        for (const LaunchRecord& launch : measurement.frames[frame].launches) {
            Sums& sums = rows.try_emplace(key_of(launch), count).first->second;
            if (frame == 0) {
                ++sums.launches;
                sums.items += launch.items;
                sums.lanes += launch.lanes;
            }
            sums.run_ns[frame] += launch.ended_ns - launch.started_ns;
            sums.queued_ns[frame] += launch.submitted_ns - launch.queued_ns;
            sums.submitted_ns[frame] += launch.started_ns - launch.submitted_ns;
            sums.gap_ns[frame] += launch.started_ns - std::min(idle_since, launch.started_ns);
            idle_since = launch.ended_ns;
        }
    }
    return rows;
}

GenerationWork work_of(const Measurement& measurement, std::uint32_t generation) {
    GenerationWork work;
    work.rays = measurement.generations[generation].rays;
    work.shadow_rays = measurement.generations[generation].shadow_rays;
    if (generation + 1 < measurement.generations.size()) {
        work.children = measurement.generations[generation + 1].rays;
    }
    work.lights = measurement.lights;
    work.spp = static_cast<std::uint32_t>(measurement.environment.spp);
    work.visits = measurement.visits[generation];
    return work;
}

/// The rays of a kernel in a generation, all of whose launches are in `sums`; of intersect those that took
/// the way `variant`.
void add_work(Sums& sums, std::string_view kernel, const std::string& variant, const GenerationWork& work) {
    const auto of_variant = work.visits.intersect.find(variant);
    const IntersectVisits intersect =
        of_variant != work.visits.intersect.end() ? of_variant->second : IntersectVisits{};
    const DeclaredCost cost = declared_cost(kernel, work, intersect);
    sums.bytes.add(cost.bytes);
    sums.flop.add(cost.flop);
    sums.rays_in = kernel == "shadow" ? work.shadow_rays : kernel == "intersect" ? intersect.rays : work.rays;
    sums.rays_out.add(kernel == "generate"    ? work.rays
                      : kernel == "intersect" ? intersect.hits
                      : kernel == "shadow"    ? work.visits.lit
                                              : work.children);
    if (kernel != "intersect" && kernel != "shadow") return;
    const KernelVisits& visits = kernel == "intersect" ? intersect.visits : work.visits.shadow;
    sums.nodes.add(visits.nodes);
    sums.leaves.add(visits.leaves);
}

std::vector<double> milliseconds(const std::vector<std::uint64_t>& ns) {
    std::vector<double> result;
    for (const std::uint64_t time : ns) result.push_back(in_ms(time));
    return result;
}

std::optional<double> quotient(std::optional<std::uint64_t> a, std::uint64_t b) {
    if (!a || b == 0) return std::nullopt;
    return static_cast<double>(*a) / static_cast<double>(b);
}

bool visits_nodes(std::string_view kernel) { return kernel == "intersect" || kernel == "shadow"; }

ProfileMeasures measures_of(const Sums& sums, bool with_visits, const Profile& profile) {
    ProfileMeasures m;
    m.launches = sums.launches;
    m.rays_in = sums.rays_in;
    m.rays_out = sums.rays_out.value();
    if (const auto survival = quotient(m.rays_out, m.rays_in)) m.survival_percent = 100 * *survival;
    m.samples_ms = milliseconds(sums.run_ns);
    m.ms_median = median(m.samples_ms);
    m.ms_p95 = quantile(m.samples_ms, 0.95);
    m.active_lanes = quotient(sums.items, sums.lanes).value_or(0);
    m.queued_to_submit_ms = median(milliseconds(sums.queued_ns));
    m.submit_to_start_ms = median(milliseconds(sums.submitted_ns));
    m.gap_ms = median(milliseconds(sums.gap_ns));
    m.wall_percent = profile.wall_ms > 0 ? 100 * m.ms_median / profile.wall_ms : 0;
    m.bytes_per_ray = quotient(sums.bytes.value(), m.rays_in);
    m.flop_per_ray = quotient(sums.flop.value(), m.rays_in);
    if (with_visits) {
        m.node_visits_per_ray = quotient(sums.nodes.value(), m.rays_in);
        m.leaf_visits_per_ray = quotient(sums.leaves.value(), m.rays_in);
    }
    if (m.ms_median <= 0 || m.rays_in == 0) return m;
    const double rays = static_cast<double>(m.rays_in);
    const double ns = m.ms_median * 1e6;
    m.mrays_per_s = rays / ns * 1e3;
    m.ns_per_ray = ns / rays;
    if (m.bytes_per_ray) {
        m.gb_per_s = *m.bytes_per_ray * rays / ns;
        m.bandwidth_percent = 100 * *m.gb_per_s / profile.calibration.bandwidth_gb_per_s;
    }
    if (m.flop_per_ray) {
        m.gflop_per_s = *m.flop_per_ray * rays / ns;
        m.fma_percent = 100 * *m.gflop_per_s / profile.calibration.fma_gflop_per_s;
    }
    return m;
}

std::string name_of(std::size_t place) { return std::string(pipeline.at(place)); }

void add_kernel_totals(Profile& profile, const std::map<RowKey, Sums>& rows, std::size_t frames) {
    std::map<std::pair<std::size_t, std::string>, Sums> totals;
    for (const auto& [key, sums] : rows) {
        const auto& [generation, place, variant] = key;
        Sums& total = totals.try_emplace({place, variant}, frames).first->second;
        total.add(sums);
        total.add_visits(sums);
    }
    for (const auto& [key, sums] : totals) {
        profile.kernel_totals.push_back({name_of(key.first), key.second, std::nullopt,
                                         measures_of(sums, visits_nodes(pipeline[key.first]), profile)});
    }
}

void add_generation_totals(Profile& profile, const std::map<RowKey, Sums>& rows,
                           const Measurement& measurement) {
    std::map<std::uint32_t, Sums> totals;
    for (const auto& [key, sums] : rows) {
        const auto& [generation, place, variant] = key;
        Sums& total = totals.try_emplace(generation, measurement.frames.size()).first->second;
        total.add(sums);
        if (visits_nodes(pipeline[place])) total.add_visits(sums);
    }
    for (auto& [generation, sums] : totals) {
        const GenerationWork work = work_of(measurement, generation);
        sums.rays_in = work.rays;
        sums.rays_out = {};
        sums.rays_out.add(work.children);
        profile.generation_totals.push_back({"", "", generation, measures_of(sums, true, profile)});
    }
}

}  // namespace

std::pair<std::string, std::string> split_name(const std::string& name) {
    const std::size_t underscore = name.rfind('_');
    if (underscore != std::string::npos) {
        const std::string variant = name.substr(underscore + 1);
        if (variant == "packet" || variant == "stream" || variant == "scalar") {
            return {name.substr(0, underscore), variant};
        }
    }
    return {name, ""};
}

void add_rows(Profile& profile, const Measurement& measurement) {
    std::map<RowKey, Sums> rows = sum_launches(measurement);
    for (auto& [key, sums] : rows) {
        const auto& [generation, place, variant] = key;
        add_work(sums, pipeline.at(place), variant, work_of(measurement, generation));
        profile.rows.push_back(
            {name_of(place), variant, generation, measures_of(sums, visits_nodes(pipeline[place]), profile)});
    }
    add_kernel_totals(profile, rows, measurement.frames.size());
    add_generation_totals(profile, rows, measurement);
}

}  // namespace sahl
