// A frame's wall clock taken apart: timelines whose sums are known.
#include <catch2/catch.hpp>

#include "engine/profile/timeline.h"

namespace sahl::tests {
namespace {

LaunchRecord launch(std::uint64_t started, std::uint64_t ended) {
    LaunchRecord record;
    record.kernel = "k";
    record.started_ns = started;
    record.ended_ns = ended;
    return record;
}

std::uint64_t exposed(const TimelineSums& sums, const char* step) { return sums.steps.at(step).exposed_ns; }

void check_adds_up(const TimelineRecord& record, const TimelineSums& sums) {
    CHECK(sums.busy_ns + sums.idle_ns == record.end_ns - record.begin_ns);
    std::uint64_t idle = sums.unattributed_ns;
    for (const auto& [name, step] : sums.steps) idle += step.exposed_ns;
    CHECK(idle == sums.idle_ns);
}

}  // namespace

TEST_CASE("timeline: idle time goes to the host step running then, the rest to none", "[profile]") {
    const TimelineRecord record{100,
                                200,
                                {launch(110, 130), launch(150, 160)},
                                {{105, "a"}, {120, nullptr}, {140, "b"}, {170, nullptr}}};
    const TimelineSums sums = add_up(record);
    check_adds_up(record, sums);
    CHECK(sums.busy_ns == 30);
    CHECK(exposed(sums, "a") == 5);   // 105 to 110
    CHECK(exposed(sums, "b") == 20);  // 140 to 150 and 160 to 170
    CHECK(sums.unattributed_ns == 45);
    CHECK(sums.steps.at("a").total_ns == 15);
    CHECK(sums.steps.at("b").total_ns == 30);
}

TEST_CASE("timeline: a step within another has its time alone", "[profile]") {
    const TimelineRecord record{
        0, 100, {launch(40, 50)}, {{10, "outer"}, {20, "inner"}, {60, nullptr}, {80, nullptr}}};
    const TimelineSums sums = add_up(record);
    check_adds_up(record, sums);
    CHECK(sums.steps.at("outer").total_ns == 30);
    CHECK(sums.steps.at("inner").total_ns == 40);
    CHECK(exposed(sums, "outer") == 30);
    CHECK(exposed(sums, "inner") == 30);
    CHECK(sums.unattributed_ns == 30);
}

TEST_CASE("timeline: what another thread does is in a step's total and never exposed", "[profile]") {
    HostStepLog log;
    add_hidden_step("encode", 70);
    const TimelineRecord record{0, 100, {launch(0, 80)}, {{85, "encode"}, {95, nullptr}}, log.take_hidden()};
    CHECK(log.take_hidden().empty());
    const TimelineSums sums = add_up(record);
    check_adds_up(record, sums);
    CHECK(sums.steps.at("encode").total_ns == 80);
    CHECK(sums.steps.at("encode").calls == 1);
    CHECK(exposed(sums, "encode") == 10);
}

TEST_CASE("timeline: what reaches outside of it is cut, what overlaps counts once", "[profile]") {
    const TimelineRecord record{50,
                                100,
                                {launch(40, 60), launch(55, 70), launch(90, 130)},
                                {{30, "early"}, {65, nullptr}, {95, "late"}}};
    const TimelineSums sums = add_up(record);
    check_adds_up(record, sums);
    CHECK(sums.busy_ns == 30);
    CHECK(sums.steps.at("early").total_ns == 15);
    CHECK(sums.steps.at("late").total_ns == 5);
    CHECK(sums.unattributed_ns == 20);
}

TEST_CASE("timeline: steps are recorded while a log lives, on its thread, nested", "[profile]") {
    { const HostStep nobody_looks("before"); }
    HostStepLog log;
    {
        const HostStep outer("outer");
        const HostStep inner("inner");
    }
    const std::vector<HostEvent> events = log.take();
    REQUIRE(events.size() == 4);
    CHECK(std::string(events[0].begins) == "outer");
    CHECK(std::string(events[1].begins) == "inner");
    CHECK(events[2].begins == nullptr);
    CHECK(events[3].begins == nullptr);
    for (std::size_t i = 1; i < events.size(); ++i) CHECK(events[i - 1].ns <= events[i].ns);
    CHECK(log.take().empty());
}

}  // namespace sahl::tests
