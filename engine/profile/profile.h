// A profile: where the time of a frame went, by kernel and generation and by host step, and how near the
// device's limits each kernel comes. docs/profile.md says what each figure means.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sahl {

/// Figures of a kernel in a generation, or of several of them together. Of one repetition unless said
/// otherwise; rates are by ms_median. Nothing where it is not known.
struct ProfileMeasures {
    std::uint64_t launches = 0;
    std::uint64_t rays_in = 0;
    std::optional<std::uint64_t> rays_out{};
    std::optional<double> survival_percent{};
    double ms_median = 0;
    double ms_p95 = 0;
    std::optional<double> mrays_per_s{};
    std::optional<double> ns_per_ray{};
    std::optional<double> bytes_per_ray{};
    std::optional<double> gb_per_s{};
    std::optional<double> bandwidth_percent{};  ///< of Calibration::bandwidth_gb_per_s
    std::optional<double> flop_per_ray{};
    std::optional<double> gflop_per_s{};
    std::optional<double> fma_percent{};  ///< of Calibration::fma_gflop_per_s
    double active_lanes = 0;              ///< rays over places for rays, 0..1
    std::optional<double> node_visits_per_ray{};
    std::optional<double> leaf_visits_per_ray{};
    double queued_to_submit_ms = 0;
    double submit_to_start_ms = 0;
    double gap_ms = 0;  ///< that the device was idle before each launch
    double wall_percent = 0;
    std::vector<double> samples_ms{};  ///< of all launches together, for each repetition
};

/// A kernel in a generation. In totals over all generations or all kernels one of both is empty.
struct ProfileRow {
    std::string kernel;   ///< generate, intersect, …
    std::string variant;  ///< packet, stream or scalar; empty: the kernel has one way
    std::optional<std::uint32_t> generation;
    ProfileMeasures measures;
};

/// How the wall clock adds up: busy + idle = wall, and exposed + unattributed = idle.
struct TimeBreakdown {
    double wall_ms = 0;
    double device_busy_ms = 0;
    double device_idle_ms = 0;
    std::map<std::string, double> exposed_ms{};  ///< idle by the host step that ran
    double unattributed_ms = 0;                  ///< idle while no host step ran
};

struct ProfileRepetition {
    TimeBreakdown time;
    bool outlier = false;
};

enum class ProfilePhase { setup, frame };

struct ProfileHostStep {
    std::string name;
    ProfilePhase phase = ProfilePhase::frame;
    std::uint64_t calls = 0;           ///< of one repetition
    double ms_total = 0;               ///< without the steps within it
    double ms_exposed = 0;             ///< of that: the device was idle
    std::vector<double> samples_ms{};  ///< of ms_total
};

/// What the device can do, as measured.
struct Calibration {
    double bandwidth_gb_per_s = 0;
    double fma_gflop_per_s = 0;
    bool cached = false;  ///< measured in an earlier run
};

/// What was measured, where. Profiles compare where these are the same.
struct ProfileEnvironment {
    std::string sahl;
    std::string scene;
    std::string scene_hash;
    std::string kernel_hash;
    std::string camera;
    int width = 0, height = 0;
    std::optional<std::vector<int>> crop;
    int depth = 0;
    int spp = 1;
    std::uint64_t seed = 0;
    std::uint32_t ray_budget = 0;
    std::string build_quality;
    std::string device;
    std::string platform;
    std::string device_version;
    std::string driver;
    std::string cpu;
    int threads = 0;
    double clock_uncertainty_ns = 0;
    double overhead_percent = 0;                                 ///< what recording adds to a frame
    double overhead_low_percent = 0, overhead_high_percent = 0;  ///< its 95 % interval
    int warm_up = 0;
};

struct Profile {
    double wall_ms = 0;          ///< median
    double unattributed_ms = 0;  ///< median
    std::uint64_t compiles_during_render = 0;
    std::uint64_t compiles_in_setup = 0;
    ProfileEnvironment environment;
    Calibration calibration;
    TimeBreakdown setup;
    std::vector<ProfileRepetition> repetitions;
    std::vector<ProfileRow> rows;
    std::vector<ProfileRow> kernel_totals;
    std::vector<ProfileRow> generation_totals;
    std::vector<ProfileHostStep> host_steps;
};

}  // namespace sahl
