// `sahl profile diff`: its table and event, its refusals and the exit status that scripts rely on.
#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"
#include "tests/support/made_profile.h"

namespace sahl::tests {
namespace {

/// base.json, and other.json, whose kernel shade takes 5 % longer.
struct ProfilePair {
    TemporaryFolder folder;

    ProfilePair() {
        write_file(folder / "base.json", made_profile({1}).dump());
        write_file(folder / "other.json", made_profile({.seed = 2, .factors = {{"shade", 1.05}}}).dump());
    }
    ProcessResult diff(std::vector<std::string> more, const std::string& base = "base.json",
                       const std::string& other = "other.json") const {
        more.insert(more.begin(), {"profile", "diff", base, other});
        return run_sahl_in(folder.path(), more);
    }
};

TEST_CASE("profile diff: the table says what is slower and warns of drift", "[cli][profile]") {
    const ProfilePair pair;
    const ProcessResult result = pair.diff({});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK_THAT(result.err, Catch::Contains("not measured in turn") && Catch::Contains("--ab"));
    std::istringstream lines(result.out);
    int slower = 0;
    for (std::string line; std::getline(lines, line);) {
        CHECK(line.size() <= 120);
        if (line.starts_with("intersect ")) CHECK_THAT(line, Catch::EndsWith("no difference"));
        if (!line.ends_with("slower")) continue;
        ++slower;
        CHECK_THAT(line, Catch::Contains("shade") || Catch::StartsWith("wall"));
    }
    CHECK(slower >= 3);
    CHECK(pair.diff({"-q"}).out == "");
}

TEST_CASE("profile diff: --fail-if exits 9 only for a slowdown that is sure", "[cli][profile]") {
    const ProfilePair pair;
    struct Case {
        std::vector<std::string> limits;
        int status;
    };
    const auto item = GENERATE(values<Case>({
        {{"--fail-if", "shade:+3%"}, 9},
        {{"--fail-if", "shade/0:+2.5%"}, 9},
        {{"--fail-if", "shade:+5%"}, 0},
        {{"--fail-if", "intersect:+0%"}, 0},
        {{"--fail-if", "intersect:+3%", "--fail-if", "shade:+3%"}, 9},
        {{"--fail-if", "intersect:+3%", "--fail-if", "wall:+50%", "-q"}, 0},
    }));
    const ProcessResult result = pair.diff(item.limits);
    INFO(result.out << result.err);
    CHECK(result.status == item.status);
    CHECK(contains(result.out, "exceeded") == (item.status == 9));
    // The other way around it is faster.
    CHECK(pair.diff(item.limits, "other.json", "base.json").status == 0);
}

TEST_CASE("profile diff: --json has every row and limit", "[cli][profile]") {
    const ProfilePair pair;
    const ProcessResult result = pair.diff({"--json", "--fail-if", "shade:+3%"});
    CHECK(result.status == 9);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    const nlohmann::json& event = events[0];
    CHECK(event.at("event") == "profile_diff");
    CHECK(event.at("interleaved") == false);
    CHECK(event.at("pairs") == 0);
    CHECK(event.at("base").at("repetitions") == 15);
    CHECK(event.at("rows").size() == 27);
    int not_tested = 0;
    for (const nlohmann::json& row : event.at("rows")) {
        CHECK(row.at("p_value").is_null() == (row.at("verdict") == "not tested"));
        not_tested += row.at("p_value").is_null() ? 1 : 0;
        if (row.at("kernel") != "shade" || !row.at("generation").is_null()) continue;
        CHECK(row.at("verdict") == "slower");
        CHECK(row.at("ratio").get<double>() == Approx(1.05).margin(0.02));
        CHECK(row.at("ratio_low").get<double>() > 1);
    }
    CHECK(not_tested >= 8);
    REQUIRE(event.at("limits").size() == 1);
    CHECK(event.at("limits")[0].at("exceeded") == true);
    CHECK(event.at("passed") == false);
    CHECK(pair.diff({"--json"}).out == pair.diff({"--json"}).out);
}

TEST_CASE("profile diff: different work is refused unless forced", "[cli][profile]") {
    const ProfilePair pair;
    nlohmann::ordered_json profile = made_profile({2});
    profile["environment"]["driver"] = "9.9";
    profile["environment"]["scene_hash"] = "other";
    write_file(pair.folder / "driver.json", profile.dump());
    const ProcessResult refused = pair.diff({}, "base.json", "driver.json");
    CHECK(refused.status == 2);
    CHECK(refused.out == "");
    CHECK_THAT(refused.err, Catch::Contains("driver: 3.1, 9.9") &&
                                Catch::Contains("scene: made.json (5ce0e)") && Catch::Contains("--force"));
    const ProcessResult forced = pair.diff({"--force"}, "base.json", "driver.json");
    CHECK(forced.status == 0);
    CHECK_THAT(forced.err, Catch::Contains("driver: 3.1, 9.9"));
    CHECK_THAT(forced.out, Catch::Contains("no difference"));
}

TEST_CASE("profile diff: what is no profile is exit status 3, what cannot be meant 2", "[cli][profile]") {
    const ProfilePair pair;
    write_file(pair.folder / "text.json", "{\"version\": 1,");
    CHECK(pair.diff({}, "missing.json").status == 3);
    CHECK(pair.diff({}, "base.json", "text.json").status == 3);
    for (const std::string limit :
         {"", "shade", "shade:", "shade:3%", "shade:+3", "shade:-3%", ":+3%", "shade:+x%"}) {
        const ProcessResult result = pair.diff({"--fail-if", limit});
        INFO(limit << result.err);
        CHECK(result.status == 2);
        CHECK_THAT(result.err, Catch::Contains("'sahl profile diff --help'"));
    }
    const ProcessResult unknown = pair.diff({"--fail-if", "shad:+3%"});
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Catch::Contains("did you mean 'shade'"));
    CHECK(run_sahl({"profile", "diff", "base.json"}).status == 2);
}

TEST_CASE("profile diff: few repetitions are warned of, and refused for limits", "[cli][profile]") {
    const ProfilePair pair;
    write_file(pair.folder / "few.json", made_profile({.seed = 3, .repetitions = 3}).dump());
    const ProcessResult result = pair.diff({}, "few.json", "few.json");
    CHECK(result.status == 0);
    CHECK_THAT(result.err, Catch::Contains("3 and 3 repetitions are too few"));
    CHECK(pair.diff({"--fail-if", "shade:+3%"}, "few.json", "few.json").status == 2);
}

}  // namespace
}  // namespace sahl::tests
