// `sahl profile` and `sahl warm` on the real program: reports that add up and refusals.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "tests/cli/sahl_program.h"
#include "tests/support/json_schema.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A profile of cli_mirrors.nff in all forms, made once.
struct Reports {
    json profile;
    json trace;
    std::string text;
    std::string csv;
};

const Reports& reports() {
    static const Reports result = [] {
        const TemporaryFolder folder;
        const ProcessResult run = run_sahl_in(
            folder.path(), {"profile", scene_file("cli_mirrors.nff"), "--size", "96x64", "--repeat", "5",
                            "--export-json", "p.json", "--export-csv", "p.csv", "--export-trace", "t.json"});
        INFO(run.err);
        REQUIRE(run.status == 0);
        return Reports{json::parse(content_of(folder.path() / "p.json")),
                       json::parse(content_of(folder.path() / "t.json")), run.out,
                       content_of(folder.path() / "p.csv")};
    }();
    return result;
}

double sum_of(const json& object) {
    double sum = 0;
    for (const auto& [name, value] : object.items()) sum += value.get<double>();
    return sum;
}

}  // namespace

TEST_CASE("profile: what it writes is what the schema says", "[cli]") {
    CHECK(JsonSchema("sahl-profile.schema.json").refusal(reports().profile) == "");
    const json& environment = reports().profile.at("environment");
    CHECK(environment.at("width") == 96);
    CHECK(environment.at("height") == 64);
    CHECK(environment.at("depth") == 4);
    CHECK(environment.at("scene_hash").get<std::string>().size() == 16);
    CHECK(reports().profile.at("calibration").at("bandwidth_gb_per_s").get<double>() > 0.1);
    CHECK(reports().profile.at("calibration").at("fma_gflop_per_s").get<double>() > 1);
    const auto overhead = [&environment](const char* what) { return environment.at(what).get<double>(); };
    CHECK(overhead("overhead_low_percent") <= overhead("overhead_percent"));
    CHECK(overhead("overhead_percent") <= overhead("overhead_high_percent"));
    CHECK(overhead("overhead_low_percent") < overhead("overhead_high_percent"));
    CHECK(overhead("overhead_low_percent") > -100);
}

TEST_CASE("profile: every repetition's time adds up to its wall clock", "[cli]") {
    const json& profile = reports().profile;
    const json& repetitions = profile.at("repetitions");
    REQUIRE(repetitions.size() == 5);
    for (std::size_t i = 0; i < repetitions.size(); ++i) {
        const json& r = repetitions[i];
        const double wall = r.at("wall_ms").get<double>();
        const double busy = r.at("device_busy_ms").get<double>();
        CHECK(busy > 0);
        CHECK(busy + r.at("device_idle_ms").get<double>() == Approx(wall));
        CHECK(sum_of(r.at("exposed")) + r.at("unattributed_ms").get<double>() ==
              Approx(r.at("device_idle_ms").get<double>()));
        double rows = 0;
        for (const json& row : profile.at("rows")) rows += row.at("samples_ms")[i].get<double>();
        CHECK(rows == Approx(busy).epsilon(1e-3));
        double totals = 0;
        for (const json& row : profile.at("generation_totals"))
            totals += row.at("samples_ms")[i].get<double>();
        CHECK(totals == Approx(rows));
        for (const char* step : {"launch", "wait", "accumulate", "encode", "write", "allocate"})
            CHECK(r.at("exposed").contains(step));
    }
}

TEST_CASE("profile: rays of a generation are the children of the one before", "[cli]") {
    std::map<std::string, std::map<int, json>> rows;
    for (const json& row : reports().profile.at("rows"))
        rows[row.at("kernel").get<std::string>()][row.at("generation").get<int>()] = row;
    CHECK(rows["generate"][0].at("rays_out") == 96 * 64);
    CHECK(rows["intersect"][0].at("rays_in") == 96 * 64);
    REQUIRE(rows["intersect"].size() == 5);
    for (int generation = 0; generation < 4; ++generation) {
        INFO(generation);
        CHECK(rows["compact"][generation].at("rays_out") == rows["intersect"][generation + 1].at("rays_in"));
        CHECK(rows["intersect"][generation].at("rays_out") <= rows["intersect"][generation].at("rays_in"));
        CHECK(rows["shadow"][generation].at("rays_out") <= rows["shadow"][generation].at("rays_in"));
    }
    CHECK(rows["intersect"][0].at("node_visits_per_ray").get<double>() > 0);
    CHECK(rows["shade"][0].at("node_visits_per_ray").is_null());
}

TEST_CASE("profile: the rays are those that a render counts", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult run = run_sahl_in(
        folder.path(), {"render", scene_file("cli_mirrors.nff"), "--size", "96x64", "-o", "a.png", "--json"});
    REQUIRE(run.status == 0);
    const json generations = json_lines(run.out).back().at("generations");
    for (const json& row : reports().profile.at("rows")) {
        const json& counts = generations.at(row.at("generation").get<std::size_t>());
        if (row.at("kernel") == "intersect") CHECK(row.at("rays_in") == counts.at("rays"));
        if (row.at("kernel") == "shadow") CHECK(row.at("rays_in") == counts.at("shadow_rays"));
    }
}

TEST_CASE("profile: the table names every kernel within 120 columns", "[cli]") {
    std::istringstream lines(reports().text);
    for (std::string line; std::getline(lines, line);) {
        INFO(line);
        // The names of scene, device and processor are as long as they are.
        if (!line.starts_with("scene") && !line.starts_with("device") && !line.starts_with("processor"))
            CHECK(line.size() <= 120);
    }
    for (const json& row : reports().profile.at("rows"))
        CHECK(contains(reports().text, row.at("kernel").get<std::string>()));
    CHECK(contains(reports().text, "unattributed"));
    CHECK(contains(reports().text, "recording adds"));
}

TEST_CASE("profile: the table's numbers are those of the JSON", "[cli]") {
    const json& rows = reports().profile.at("rows");
    const auto row = std::find_if(rows.begin(), rows.end(), [](const json& candidate) {
        return candidate.at("kernel") == "shade" && candidate.at("generation") == 0;
    });
    REQUIRE(row != rows.end());
    const auto fixed = [&](const char* key, int digits, double unit = 1) {
        return fmt::format("{:.{}f}", unit * row->at(key).get<double>(), digits);
    };
    std::istringstream lines(reports().text);
    std::string line;
    while (std::getline(lines, line) && !line.starts_with("  0 shade ")) {
    }
    std::istringstream words(line);
    const std::vector<std::string> cells(std::istream_iterator<std::string>(words), {});
    REQUIRE(cells.size() == 15);
    CHECK(cells[2] == fmt::format("{}", row->at("launches").get<int>()));
    CHECK(cells[5] == fixed("survival_percent", 1));
    CHECK(cells[6] == fixed("ms_median", 3));
    CHECK(cells[7] == fixed("ms_p95", 3));
    CHECK(cells[8] == fixed("wall_percent", 1));
    CHECK(cells[11] == fixed("active_lanes", 1, 100));
}

TEST_CASE("profile: the trace has a slice for each launch, tracks with names and whole flows", "[cli]") {
    std::map<std::pair<int, int>, std::string> tracks;
    std::map<int, std::string> flows;  // phases of each, in order
    std::size_t launches = 0;
    for (const json& event : reports().trace.at("traceEvents")) {
        const std::string phase = event.at("ph").get<std::string>();
        const std::pair<int, int> track{event.at("pid").get<int>(), event.at("tid").get<int>()};
        if (phase == "M") {
            if (event.at("name") == "thread_name")
                tracks[track] = event.at("args").at("name").get<std::string>();
            continue;
        }
        CHECK(tracks.contains(track));
        CHECK(event.at("ts").get<double>() >= 0);
        if (phase == "X") {
            CHECK(event.at("dur").get<double>() >= 0);
            if (event.contains("args")) {
                ++launches;
                CHECK(tracks[track] == event.at("name").get<std::string>());
            }
        } else {
            flows[event.at("id").get<int>()] += phase;
        }
    }
    std::uint64_t in_rows = 0;
    for (const json& row : reports().profile.at("rows")) in_rows += row.at("launches").get<std::uint64_t>();
    CHECK(launches >= 5 * in_rows);  // those of the setup too
    CHECK(!flows.empty());
    for (const auto& [id, phases] : flows) {
        CHECK(phases.front() == 's');
        CHECK(phases.back() == 'f');
        CHECK(phases.find_first_not_of('t', 1) == phases.size() - 1);
    }
}

TEST_CASE("profile: -q prints nothing, with --json the profile is one event", "[cli]") {
    const std::vector<std::string> quiet{
        "profile", scene_file("cli_mirrors.nff"), "--size", "16x16", "--repeat", "1", "-q"};
    const ProcessResult nothing = run_sahl(quiet);
    CHECK(nothing.status == 0);
    CHECK(nothing.out + nothing.err == "");
    std::vector<std::string> with_event = quiet;
    with_event.push_back("--json");
    const ProcessResult run = run_sahl(with_event);
    REQUIRE(run.status == 0);
    std::vector<json> events = json_lines(run.out);
    REQUIRE(events.size() == 1);
    CHECK(events[0].at("event") == "profile");
    events[0].erase("event");
    CHECK(JsonSchema("sahl-profile.schema.json").refusal(events[0]) == "");
}

TEST_CASE("profile: --assert-no-jit fails with compiles and passes after sahl warm", "[cli]") {
    const TemporaryFolder folder;
    ProcessOptions options;
    options.environment["SAHL_CACHE_DIR"] = (folder.path() / "cache").string();
    const std::vector<std::string> profile{
        "profile", scene_file("cli_mirrors.nff"), "--size", "16x16", "--repeat", "1", "--assert-no-jit"};
    const ProcessResult cold = run_sahl(profile, options);
    CHECK(cold.status == 9);
    CHECK(contains(cold.err, "sahl warm"));
    options.environment["SAHL_CACHE_DIR"] = (folder.path() / "other").string();
    const auto cached_bytes = [&] {
        std::uintmax_t bytes = 0;
        for (const auto& file : fs::directory_iterator(folder.path() / "other")) bytes += file.file_size();
        return bytes;
    };
    for (const std::vector<std::string>& way : {std::vector<std::string>{}, {"--traversal", "scalar"}}) {
        std::vector<std::string> warm{"warm", "--json"};
        warm.insert(warm.end(), way.begin(), way.end());
        std::vector<std::string> same_way = profile;
        same_way.insert(same_way.end(), way.begin(), way.end());
        const ProcessResult first = run_sahl(warm, options);
        REQUIRE(first.status == 0);
        CHECK(json_lines(first.out).back().at("compiled") > 0);
        const ProcessResult second = run_sahl(same_way, options);
        INFO(second.err);
        CHECK(second.status == 0);
        CHECK(contains(second.out, "during render: 0, before: 0"));
    }
    // A render and its AOVs add no kernel either.
    const std::uintmax_t warm_bytes = cached_bytes();
    const ProcessResult image = run_sahl({"render", scene_file("cli_mirrors.nff"), "--size", "16x16", "--aov",
                                          "N", "-o", (folder.path() / "image.exr").string()},
                                         options);
    INFO(image.err);
    CHECK(image.status == 0);
    CHECK(cached_bytes() == warm_bytes);
    CHECK(json_lines(run_sahl({"warm", "--json"}, options).out).back().at("compiled") == 0);
}

TEST_CASE("profile: refusals come before the measurement", "[cli]") {
    struct Refusal {
        std::vector<std::string> arguments;
        int status;
        std::string message;
    };
    const auto refusal = GENERATE(values<Refusal>({
        {{"profile"}, 2, "SCENE is required"},
        {{"profile", "no.nff"}, 3, "no.nff"},
        {{"profile", scene_file("cli_mirrors.nff"), "--repeat", "0"}, 2, "--repeat '0'"},
        {{"profile", scene_file("cli_mirrors.nff"), "--warm-up", "-1"}, 2, "--warm-up '-1'"},
        {{"profile", scene_file("cli_mirrors.nff"), "--depth", "1,2"}, 2, "one depth"},
        {{"profile", scene_file("cli_mirrors.nff"), "--crop", "0,0,999,9"}, 2, "outside the image"},
        {{"profile", scene_file("cli_mirrors.nff"), "--export-json", "."}, 6, "."},
        {{"profile", scene_file("cli_mirrors.nff"), "--max-mem", "1K"}, 5, "memory"},
        {{"warm", "no.nff"}, 3, "no.nff"},
    }));
    const TemporaryFolder folder;
    const ProcessResult run = run_sahl_in(folder.path(), refusal.arguments);
    INFO(run.err);
    CHECK(run.status == refusal.status);
    CHECK(contains(run.err, refusal.message));
    CHECK(run.out == "");
}

}  // namespace sahl::tests
