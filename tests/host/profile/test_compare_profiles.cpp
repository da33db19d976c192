// Two profiles side by side, with made-up times whose truth is known.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "engine/core/error.h"
#include "engine/profile/compare_profiles.h"
#include "tests/support/made_profile.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

ProfileTimes times_in(const nlohmann::ordered_json& profile) {
    const TemporaryFolder folder;
    std::ofstream(folder / "profile.json") << profile;
    return read_profile_times(folder / "profile.json");
}

ProfileTimes made_times(const MadeProfile& made) { return times_in(made_profile(made)); }

const RowComparison& row_of(const ProfileComparison& comparison, const std::string& name) {
    for (const RowComparison& row : comparison.rows) {
        if (name_of(row.row) == name) return row;
    }
    throw std::runtime_error("no row " + name);
}

std::string message_of(const nlohmann::ordered_json& profile) {
    try {
        times_in(profile);
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        return error.what();
    }
    return "no error";
}

TEST_CASE("profile times: the made-up profile is what the schema describes", "[profile]") {
    std::ifstream file(std::string(std::getenv("SAHL_SOURCE_DIR")) + "/docs/sahl-profile.schema.json");
    const nlohmann::json document = nlohmann::json::parse(file);
    const nlohmann::json profile = made_profile();
    valijson::Schema schema;
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
    valijson::Validator validator;
    valijson::ValidationResults results;
    const bool valid = validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(profile), &results);
    valijson::ValidationResults::Error error;
    while (results.popError(error))
        UNSCOPED_INFO(fmt::format("{}", fmt::join(error.context, "")) << error.description);
    CHECK(valid);
}

TEST_CASE("profile times: kernels add up over generations and variants", "[profile]") {
    const nlohmann::ordered_json profile = made_profile();
    const ProfileTimes times = times_in(profile);
    REQUIRE(times.rows.front().kernel == "wall");
    CHECK(times.rows.front().samples_ms[3] == profile["repetitions"][3]["wall_ms"].get<double>());
    double sum = 0;
    for (const auto& row : profile["rows"]) {
        if (row["kernel"] == "shadow") sum += row["samples_ms"][3].get<double>();
    }
    std::vector<std::string> names;
    for (const TimedRow& row : times.rows) {
        names.push_back(name_of(row));
        if (names.back() == "shadow") CHECK(row.samples_ms[3] == Approx(sum));
    }
    CHECK(
        fmt::format("{}", fmt::join(names, " ")) ==
        "wall generate generate/0 intersect intersect/0 intersect/1 intersect/2 shade shade/0 shade/1 "
        "shade/2 "
        "shadow shadow/0 shadow/1 shadow/2 count_children count_children/0 count_children/1 count_children/2 "
        "sum_children sum_children/0 sum_children/1 sum_children/2 compact compact/0 compact/1 compact/2");
}

TEST_CASE("profile times: of recorded frames", "[profile]") {
    const auto launch = [](const char* kernel, std::uint32_t generation, std::uint64_t begin,
                           std::uint64_t end) {
        LaunchRecord record;
        record.kernel = kernel;
        record.generation = generation;
        record.started_ns = begin;
        record.ended_ns = end;
        return record;
    };
    // Two waves: a kernel is launched twice in a generation.
    TimelineRecord first{0, 5'000'000, {}, {}};
    first.launches = {launch("shade", 0, 0, 1'000'000), launch("intersect_packet", 1, 1'000'000, 1'500'000),
                      launch("shade", 0, 2'000'000, 4'000'000)};
    TimelineRecord second{7'000'000, 13'000'000, {}, {}};
    second.launches = {launch("shade", 0, 7'000'000, 9'000'000),
                       launch("intersect_stream", 1, 9'000'000, 9'250'000),
                       launch("shade", 0, 10'000'000, 12'000'000)};
    const ProfileTimes times = times_of({}, {first, second});
    REQUIRE(times.rows.size() == 5);
    CHECK(name_of(times.rows[0]) == "wall");
    CHECK(times.rows[0].samples_ms == std::vector<double>{5, 6});
    CHECK(name_of(times.rows[2]) == "shade/0");
    CHECK(times.rows[2].samples_ms == std::vector<double>{3, 4});
    CHECK(name_of(times.rows[4]) == "intersect/1");
    CHECK(times.rows[4].samples_ms == std::vector<double>{0.5, 0.25});
}

TEST_CASE("profile times: files that are no profiles are refused with what is wrong and where", "[profile]") {
    const nlohmann::ordered_json good = made_profile();
    nlohmann::ordered_json bad = good;
    bad["version"] = 2;
    CHECK_THAT(message_of(bad), Catch::Contains("version 2 of the format"));
    bad = good;
    bad.erase("repetitions");
    CHECK_THAT(message_of(bad), Catch::Contains("it has no \"repetitions\""));
    bad = good;
    bad["rows"][4]["samples_ms"].erase(0);
    CHECK_THAT(message_of(bad),
               Catch::Contains("/rows/4/samples_ms has not one time for each of 15 repetitions"));
    bad = good;
    bad["rows"][1]["samples_ms"][2] = -1;
    CHECK_THAT(message_of(bad), Catch::Contains("/rows/1/samples_ms/2 is no number from 0 on"));
    bad = good;
    bad["environment"]["device"] = 5;
    CHECK_THAT(message_of(bad), Catch::Contains("/environment/device is no string"));
    bad = good;
    bad["repetitions"] = nlohmann::json::array();
    CHECK_THAT(message_of(bad), Catch::Contains("/repetitions is empty"));
    CHECK_THAT(message_of(nlohmann::json::array()), Catch::Contains("it has no \"version\""));
    CHECK_THROWS_WITH(read_profile_times("/no/such.json"), Catch::Contains("/no/such.json: cannot be read"));
}

TEST_CASE("compare profiles: a slower kernel is found, and only it and what holds it", "[profile]") {
    const ProfileComparison comparison =
        compare_profiles(made_times({1}), made_times({.seed = 2, .factors = {{"shade", 1.05}}}), false);
    for (const RowComparison& row : comparison.rows) {
        INFO(name_of(row.row) << " " << row.ratio << " p " << row.p_value.value_or(-1));
        const bool shade = row.row.kernel == "shade";
        if (row.row.kernel != "wall") {
            CHECK(row.verdict == (shade ? SpeedVerdict::slower : SpeedVerdict::no_difference));
        }
        if (shade) CHECK(row.ratio == Approx(1.05).margin(0.02));
        CHECK(row.interval.low <= row.ratio);
        CHECK(row.interval.high >= row.ratio);
        // What takes less than a hundredth of a frame is not tested.
        const bool small = row.row.kernel == "count_children" || row.row.kernel == "sum_children";
        if (small) CHECK(!row.p_value);
    }
    CHECK(row_of(comparison, "intersect").p_value);
    CHECK(!comparison.too_few_repetitions);
    CHECK(comparison.unmatched.empty());
}

TEST_CASE("compare profiles: a faster kernel is faster", "[profile]") {
    const ProfileComparison comparison =
        compare_profiles(made_times({1}), made_times({.seed = 2, .factors = {{"intersect", 0.9}}}), false);
    CHECK(row_of(comparison, "intersect/0").verdict == SpeedVerdict::faster);
    CHECK(row_of(comparison, "shadow/0").verdict == SpeedVerdict::no_difference);
}

TEST_CASE("compare profiles: equal work is no difference in 99 of 100 comparisons", "[profile]") {
    int alarms = 0;
    for (std::uint64_t run = 0; run < 100; ++run) {
        const ProfileComparison comparison =
            compare_profiles(made_times({2 * run}), made_times({2 * run + 1}), false);
        const auto differs = [](const RowComparison& row) {
            return row.verdict != SpeedVerdict::no_difference;
        };
        alarms += std::any_of(comparison.rows.begin(), comparison.rows.end(), differs) ? 1 : 0;
    }
    CHECK(alarms <= 3);
}

TEST_CASE("compare profiles: rows that one side alone has are named", "[profile]") {
    nlohmann::ordered_json shallow = made_profile();
    auto& rows = shallow["rows"];
    rows.erase(
        std::remove_if(rows.begin(), rows.end(), [](const auto& row) { return row["generation"] == 2; }),
        rows.end());
    const std::vector<std::string> names{"intersect/2",      "shade/2",        "shadow/2",
                                         "count_children/2", "sum_children/2", "compact/2"};
    CHECK(compare_profiles(times_in(shallow), made_times({2}), false).unmatched == names);
    CHECK(compare_profiles(made_times({2}), times_in(shallow), false).unmatched == names);
}

TEST_CASE("compare profiles: too few repetitions to find anything are said to be", "[profile]") {
    const ProfileTimes base = made_times({.seed = 1, .repetitions = 4});
    const ProfileTimes other = made_times({.seed = 2, .repetitions = 4, .factors = {{"shade", 3}}});
    CHECK(compare_profiles(base, other, false).too_few_repetitions);
    CHECK_THROWS_WITH(check_limits(base, other, false, {{"shade", 3}}),
                      Catch::Contains("4 and 4 repetitions"));
    CHECK(check_limits(base, other, false, {}).empty());
}

TEST_CASE("limits: exceeded only where the slowdown is larger by more than chance", "[profile]") {
    const ProfileTimes base = made_times({1});
    const ProfileTimes other = made_times({.seed = 2, .factors = {{"shade", 1.05}}});
    const auto exceeded = [&](const std::string& row, double percent) {
        return check_limits(base, other, false, {{row, percent}}).at(0).exceeded;
    };
    CHECK(exceeded("shade", 0));
    CHECK(exceeded("shade", 3));
    CHECK(exceeded("shade/0", 3));
    CHECK(!exceeded("shade", 5));  // about as slow: not surely above
    CHECK(!exceeded("shade", 20));
    CHECK(!exceeded("intersect", 0));
    CHECK(!check_limits(other, base, false, {{"shade", 3}}).at(0).exceeded);  // faster
}

TEST_CASE("limits: a row that there is not is refused with the nearest name", "[profile]") {
    const ProfileTimes times = made_times({1});
    CHECK_THROWS_WITH(check_limits(times, times, false, {{"intersekt", 3}}),
                      Catch::Contains("did you mean 'intersect'"));
}

TEST_CASE("profiles of different scenes, settings, devices or drivers are no comparison", "[profile]") {
    const ProfileEnvironment environment = made_times({1}).environment;
    CHECK(incomparable(environment, environment).empty());
    ProfileEnvironment other = environment;
    other.kernel_hash = "another";  // what is compared
    other.build_quality = "fast";
    other.ray_budget = 1;
    CHECK(incomparable(environment, other).empty());
    const auto changed = [&](auto member, auto value) {
        ProfileEnvironment one = environment;
        one.*member = value;
        return incomparable(environment, one);
    };
    CHECK(changed(&ProfileEnvironment::scene_hash, "other") ==
          "scene: made.json (5ce0e), made.json (other)\n");
    CHECK(changed(&ProfileEnvironment::device, "gpu") == "device: made, gpu\n");
    CHECK(changed(&ProfileEnvironment::driver, "3.2") == "driver: 3.1, 3.2\n");
    CHECK(changed(&ProfileEnvironment::threads, 4) == "threads: 2, 4\n");
    CHECK(changed(&ProfileEnvironment::depth, 5) == "depth: 2, 5\n");
    CHECK(changed(&ProfileEnvironment::width, 5) == "width: 256, 5\n");
    CHECK(changed(&ProfileEnvironment::crop, std::vector<int>{0, 0, 1, 1}) == "crop: none, 0,0,1,1\n");
}

}  // namespace
}  // namespace sahl::tests
