// From recorded frames to rows: frames whose figures can be counted by hand.
#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/error.h"
#include "engine/profile/profile_csv.h"
#include "engine/profile/profile_json.h"
#include "engine/profile/summarize.h"
#include "tests/support/json_schema.h"

namespace sahl::tests {
namespace {

constexpr std::uint64_t ms = 1'000'000;

LaunchRecord launch(const std::string& kernel, std::uint32_t generation, std::uint64_t items,
                    std::uint64_t start, std::uint64_t end) {
    return {kernel, generation, items, 2 * items, start - 2000, start - 1000, start, end};
}

/// Two generations; a frame takes `scale` times 20 ms, of which kernels run 10.
TimelineRecord frame(std::uint64_t scale) {
    const std::uint64_t unit = scale * ms;
    return {0,
            20 * unit,
            {launch("generate", 0, 100, 1 * unit, 2 * unit),
             launch("intersect_packet", 0, 100, 2 * unit, 6 * unit),
             launch("shadow_packet", 0, 100, 6 * unit, 7 * unit),
             launch("intersect_stream", 1, 40, 10 * unit, 13 * unit),
             launch("shadow_stream", 1, 40, 14 * unit, 15 * unit)},
            {{7 * unit, "wait"}, {10 * unit, nullptr}, {15 * unit, "write"}, {20 * unit, nullptr}}};
}

Measurement measurement() {
    Measurement m;
    m.environment.build_quality = "high";
    m.environment.width = m.environment.height = m.environment.threads = 1;
    m.environment.ray_budget = 64;
    m.calibration = {10, 100, false};
    m.setup = {0, 5 * ms, {}, {{0, "load scene"}, {4 * ms, nullptr}}};
    m.frames = {frame(1), frame(3), frame(1)};
    m.generations = {{100, 80}, {40, 10}};
    m.visits.resize(2);
    m.visits[0] = {{{"packet", {{500, 300, 3000, 20000}, 100, 90}}}, {80, 40, 400, 1000}, 60};
    m.visits[1] = {{{"stream", {{400, 200, 2000, 10000}, 40, 10}}}, {30, 20, 200, 500}, 10};
    m.lights = 1;
    return m;
}

const ProfileRow& row_of(const std::vector<ProfileRow>& rows, const std::string& kernel,
                         std::optional<std::uint32_t> generation) {
    for (const ProfileRow& row : rows) {
        if (row.kernel == kernel && row.generation == generation) return row;
    }
    FAIL("no row of " << kernel);
    return rows.front();
}

}  // namespace

TEST_CASE("profile: a row has its kernel's rays, times, speed and shares", "[profile]") {
    const Profile profile = summarize(measurement());
    CHECK(profile.wall_ms == Approx(20));
    const ProfileRow& row = row_of(profile.rows, "intersect", 0);
    const ProfileMeasures& m = row.measures;
    CHECK(row.variant == "packet");
    CHECK(m.launches == 1);
    CHECK(m.rays_in == 100);
    CHECK(m.rays_out == 90);
    CHECK(m.survival_percent == Approx(90));
    CHECK(m.samples_ms == std::vector<double>{4, 12, 4});
    CHECK(m.ms_median == Approx(4));
    CHECK(m.ms_p95 == Approx(11.2));
    CHECK(m.wall_percent == Approx(20));
    CHECK(m.mrays_per_s == Approx(0.025));
    CHECK(m.ns_per_ray == Approx(40000));
    CHECK(m.active_lanes == Approx(0.5));
    CHECK(m.node_visits_per_ray == Approx(5));
    CHECK(m.leaf_visits_per_ray == Approx(3));
    CHECK(m.bytes_per_ray == Approx(32 + 20 + 5 * 256 + 30));
    CHECK(m.gb_per_s == Approx(1362 * 100 / 4e6));
    CHECK(m.bandwidth_percent == Approx(100 * 0.03405 / 10));
    CHECK(m.flop_per_ray == Approx(200 + 47));
    CHECK(m.fma_percent == Approx(24700 / 4e6));
    CHECK(m.queued_to_submit_ms == Approx(0.001));
    CHECK(m.submit_to_start_ms == Approx(0.001));
    CHECK(m.gap_ms == 0);
    CHECK(row_of(profile.rows, "generate", 0).measures.gap_ms == Approx(1));
    CHECK(row_of(profile.rows, "intersect", 1).measures.gap_ms == Approx(3));
}

TEST_CASE("profile: shadow rows count shadow rays, and those that reach their light", "[profile]") {
    const Profile profile = summarize(measurement());
    const ProfileMeasures& m = row_of(profile.rows, "shadow", 0).measures;
    CHECK(m.rays_in == 80);
    CHECK(m.rays_out == 60);
    CHECK(m.node_visits_per_ray == Approx(1));
    CHECK(m.leaf_visits_per_ray == Approx(0.5));
    // Outcomes, what rays start from and bring, lamps by eight rays, light added, nodes and blocks.
    CHECK(m.bytes_per_ray == Approx((100 * 4 + 80 * 44 + 10 * 64 + 60 * 36 + 80 * 256 + 400) / 80.0));
    CHECK(m.flop_per_ray == Approx(1000 / 80.0 + 47));
}

TEST_CASE("profile: camera rays cost the same everywhere, more with several in a pixel", "[profile]") {
    Measurement m = measurement();
    const ProfileMeasures one = row_of(summarize(m).rows, "generate", 0).measures;
    CHECK(one.bytes_per_ray == Approx(72));
    CHECK(one.flop_per_ray == Approx(13 * (8 * 30 + 9) / 100.0));  // by groups of eight
    m.environment.spp = 4;
    CHECK(row_of(summarize(m).rows, "generate", 0).measures.flop_per_ray ==
          Approx(13 * (8 * 34 + 9) / 100.0));
}

TEST_CASE("profile: shading has the bytes that are declared, and the operations that were counted",
          "[profile]") {
    Measurement m = measurement();
    m.visits[1].shade.flop = 7000;
    for (TimelineRecord& frame : m.frames) {
        frame.launches.push_back(launch("shade", 1, 40, 15 * ms, 16 * ms));
    }
    // One frame is three times as long: there a later place is free.
    m.frames[1].launches.back().started_ns = 50 * ms;
    m.frames[1].launches.back().ended_ns = 51 * ms;
    const Profile profile = summarize(m);
    const ProfileMeasures& shade = row_of(profile.rows, "shade", 1).measures;
    // Each ray 60; each of 10 hits the exact ray, its primitive and triangle, the surface, light of a lamp;
    // and of two groups the material and the lamp.
    CHECK(shade.bytes_per_ray == Approx((40 * 60 + 10 * (48 + 16 + 36 + 24 + 12) + 2 * (128 + 64)) / 40.0));
    CHECK(shade.flop_per_ray == Approx(7000 / 40.0));
    CHECK(shade.gflop_per_s == Approx(7000 / 1e6));
    CHECK(profile.generation_totals[1].measures.flop_per_ray);
}

TEST_CASE("profile: of a generation whose batches go different ways each row has its own rays", "[profile]") {
    Measurement m = measurement();
    m.visits[1].intersect = {{"packet", {{900, 300, 3000, 6000}, 30, 8}},
                             {"stream", {{400, 200, 2000, 10000}, 10, 2}}};
    for (TimelineRecord& frame : m.frames) {
        frame.launches.push_back(launch("intersect_packet", 1, 30, 15 * ms, 16 * ms));
    }
    m.frames[1].launches.back().started_ns = 50 * ms;
    m.frames[1].launches.back().ended_ns = 51 * ms;
    const Profile profile = summarize(m);
    const auto way = [&](const std::string& variant) {
        const auto row = std::find_if(profile.rows.begin(), profile.rows.end(), [&](const ProfileRow& r) {
            return r.kernel == "intersect" && r.variant == variant && r.generation == 1;
        });
        REQUIRE(row != profile.rows.end());
        return row->measures;
    };
    CHECK(way("packet").rays_in == 30);
    CHECK(way("packet").rays_out == 8);
    CHECK(way("packet").node_visits_per_ray == Approx(30));
    CHECK(way("packet").flop_per_ray == Approx(6000 / 30.0 + 47));
    CHECK(way("stream").rays_in == 10);
    CHECK(way("stream").rays_out == 2);
    CHECK(way("stream").node_visits_per_ray == Approx(40));
    CHECK(way("stream").bytes_per_ray == Approx((10 * 52 + 400 * 256 + 2000) / 10.0));
}

TEST_CASE("profile: totals are the sums of rows", "[profile]") {
    const Profile profile = summarize(measurement());
    CHECK(profile.kernel_totals.size() == 5);  // each variant for itself
    REQUIRE(profile.generation_totals.size() == 2);
    const ProfileMeasures& first = profile.generation_totals[0].measures;
    CHECK(first.launches == 3);
    CHECK(first.samples_ms == std::vector<double>{6, 18, 6});
    CHECK(first.rays_in == 100);
    CHECK(first.rays_out == 40);
    CHECK(first.node_visits_per_ray == Approx(5.8));
    CHECK(first.flop_per_ray == Approx((13 * 249 + 20000 + 1000 + 180 * 47) / 100.0));
    CHECK(profile.generation_totals[1].measures.flop_per_ray == Approx((10000 + 500 + 50 * 47) / 40.0));
}

TEST_CASE("profile: each repetition adds up, rows to the device's time and steps to its idle time",
          "[profile]") {
    const Profile profile = summarize(measurement());
    REQUIRE(profile.repetitions.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const TimeBreakdown& time = profile.repetitions[i].time;
        CHECK(time.device_busy_ms + time.device_idle_ms == Approx(time.wall_ms));
        double rows = 0;
        for (const ProfileRow& row : profile.rows) rows += row.measures.samples_ms[i];
        CHECK(rows == Approx(time.device_busy_ms));
        CHECK(time.exposed_ms.at("wait") + time.exposed_ms.at("write") + time.unattributed_ms ==
              Approx(time.device_idle_ms));
    }
    CHECK(profile.repetitions[0].time.unattributed_ms == Approx(2));
    CHECK(profile.repetitions[1].outlier);
    CHECK(!profile.repetitions[0].outlier);
    CHECK(profile.setup.exposed_ms.at("load scene") == Approx(4));
    CHECK(profile.setup.unattributed_ms == Approx(1));
}

TEST_CASE("profile: launches that overlap are no measurement", "[profile]") {
    Measurement overlapping = measurement();
    overlapping.frames[1].launches[1].started_ns -= 2 * ms;
    CHECK_THROWS_AS(summarize(overlapping), Error);
}

TEST_CASE("profile: the JSON is what its schema says", "[profile]") {
    const nlohmann::json json = nlohmann::json::parse(profile_json(summarize(measurement())));
    const JsonSchema schema("sahl-profile.schema.json");
    CHECK(schema.refusal(json) == "");
    nlohmann::json wrong = json;
    wrong["rows"][0].erase("samples_ms");
    CHECK(schema.refusal(wrong) != "");
    wrong = json;
    wrong["rows"][0]["more"] = 1;
    CHECK(schema.refusal(wrong) != "");
    CHECK(json.at("rows")[0].at("node_visits_per_ray").is_null());
}

TEST_CASE("profile: the CSV has as many cells in each line, one line a row", "[profile]") {
    const Profile profile = summarize(measurement());
    const std::string csv = profile_csv(profile);
    std::vector<std::size_t> cells;
    for (std::size_t begin = 0; begin < csv.size();) {
        const std::size_t end = csv.find("\r\n", begin);
        REQUIRE(end != std::string::npos);
        const std::string line = csv.substr(begin, end - begin);
        cells.push_back(static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1);
        begin = end + 2;
    }
    CHECK(cells.size() == profile.rows.size() + 1);
    CHECK(cells == std::vector<std::size_t>(cells.size(), 24));
    CHECK(csv.find("\r\nintersect,packet,0,1,100,90,90,4,") != std::string::npos);
}

}  // namespace sahl::tests
