// Rank tests against counts by hand, tables and the rate of false alarms that they promise.
#include <catch2/catch.hpp>

#include "engine/profile/rank_tests.h"
#include "tests/host/profile/random_times.h"

namespace sahl::tests {
namespace {

/// Pairs whose quotients are 1 plus these percents.
TwoSides pairs_of(const std::vector<double>& percents) {
    TwoSides times{{}, {}, true};
    for (const double percent : percents) {
        times.base.push_back(100);
        times.other.push_back(100 + percent);
    }
    return times;
}

TEST_CASE("rank tests: pairs, counted by hand", "[profile]") {
    const TwoSides all_longer = pairs_of({1, 2, 3, 4, 5});
    CHECK(rank_test(all_longer, Alternative::longer) == Approx(1 / 32.0));
    CHECK(rank_test(all_longer, Alternative::different) == Approx(2 / 32.0));
    CHECK(rank_test(all_longer, Alternative::shorter) == 1);
    CHECK(rank_test(pairs_of({-1, 2, 3, 4, 5}), Alternative::longer) == Approx(2 / 32.0));
    CHECK(rank_test(pairs_of({1, -2, -3, -4, -5}), Alternative::shorter) == Approx(2 / 32.0));
    // Pairs without a difference say nothing.
    CHECK(rank_test(pairs_of({1, 2, 3, 4, 5, 0, 0}), Alternative::longer) == Approx(1 / 32.0));
    CHECK(rank_test(pairs_of({0, 0, 0}), Alternative::different) == 1);
}

TEST_CASE("rank tests: the critical value of Wilcoxon's table for ten pairs", "[profile]") {
    // Negative ranks sum to 8, the tabled value for 5 %: 25 of the 1024 signs reach it.
    const TwoSides times = pairs_of({-1, 2, 3, 4, 5, 6, -7, 8, 9, 10});
    CHECK(rank_test(times, Alternative::different) == Approx(2 * 25 / 1024.0));
}

TEST_CASE("rank tests: two sides, counted by hand and by the table of Mann and Whitney", "[profile]") {
    const TwoSides apart{{1, 2, 3}, {4, 5, 6}};
    CHECK(rank_test(apart, Alternative::longer) == Approx(1 / 20.0));
    CHECK(rank_test(apart, Alternative::shorter) == 1);
    CHECK(rank_test(apart, Alternative::different) == Approx(2 / 20.0));
    // U = 2, the tabled value for 5 and 5 at 5 %: 4 of the 252 choices reach it.
    CHECK(rank_test({{1, 2, 3, 4, 7}, {5, 6, 8, 9, 10}}, Alternative::different) == Approx(2 * 4 / 252.0));
    // Shared ranks: 10 of the 20 choices have two or three of the larger value.
    CHECK(rank_test({{1, 1, 2}, {1, 2, 2}}, Alternative::longer) == Approx(0.5));
    // Sides of different sizes: one of C(6, 2).
    CHECK(rank_test({{1, 2, 3, 4}, {5, 6}}, Alternative::longer) == Approx(1 / 15.0));
}

TEST_CASE("rank tests: against a ratio", "[profile]") {
    const TwoSides pairs = pairs_of({5.1, 5.2, 5.3, 5.4, 5.5});
    CHECK(rank_test(pairs, Alternative::longer, 1.03) == Approx(1 / 32.0));
    CHECK(rank_test(pairs, Alternative::longer, 1.06) == 1);
    const TwoSides sides{{100, 101, 102}, {110, 111, 112}};
    CHECK(rank_test(sides, Alternative::longer, 1.05) == Approx(1 / 20.0));
    CHECK(rank_test(sides, Alternative::shorter, 1.2) == Approx(1 / 20.0));
}

TEST_CASE("rank tests: false alarms come as often as the level says, findings nearly always", "[profile]") {
    const bool paired = GENERATE(false, true);
    const std::size_t repetitions = GENERATE(15, 20, 60);  // exact, and beyond 50 approximated
    constexpr int runs = 1000;
    int alarms = 0;
    int findings = 0;
    for (int run = 0; run < runs; ++run) {
        RandomTimes random(static_cast<std::uint64_t>(run) + 1000);
        alarms +=
            rank_test(random.sides(repetitions, 1, 0.02, paired), Alternative::different) <= 0.05 ? 1 : 0;
        findings +=
            rank_test(random.sides(repetitions, 1.05, 0.015, paired), Alternative::longer) <= 0.05 ? 1 : 0;
    }
    INFO(repetitions << (paired ? " pairs: " : " a side: ") << alarms << " alarms, " << findings
                     << " findings");
    CHECK(alarms >= 25);
    CHECK(alarms <= 70);  // 50 expected, three standard deviations are 21
    CHECK(findings >= 950);
}

TEST_CASE("rank tests: the least p value that so many repetitions can give", "[profile]") {
    CHECK(least_p_value(5, 5, false) == Approx(2 / 252.0));
    CHECK(least_p_value(3, 4, false) == Approx(2 / 35.0));
    CHECK(least_p_value(10, 10, true) == Approx(2 / 1024.0));
    CHECK(least_p_value(1, 1, true) == 1);
}

}  // namespace
}  // namespace sahl::tests
