// Medians, bootstrap intervals and Holm's adjustment on values with known answers.
#include <catch2/catch.hpp>

#include "tests/host/profile/random_times.h"

namespace sahl::tests {
namespace {

TEST_CASE("statistics: quantiles lie between neighbours", "[profile]") {
    const std::vector<double> values{40, 10, 30, 20};
    CHECK(median(values) == 25);
    CHECK(median(std::vector<double>{3, 1, 2}) == 2);
    CHECK(median(std::vector<double>{7}) == 7);
    CHECK(quantile(values, 0) == 10);
    CHECK(quantile(values, 1) == 40);
    CHECK(quantile(values, 0.95) == Approx(38.5));
    CHECK(quantile(values, 0.1) == Approx(13));
}

TEST_CASE("statistics: the ratio is of medians, or of pairs the median of quotients", "[profile]") {
    // Every pair says 1.1; the machine was twice as slow for half of them.
    const TwoSides pairs{{10, 20, 10, 20, 20}, {11, 22, 11, 22, 22}, true};
    CHECK(ratio_of(pairs) == Approx(1.1));
    CHECK(ratio_of({{10, 11, 12}, {10, 22, 500}}) == Approx(2));
}

TEST_CASE("statistics: a bootstrap interval is always the same and has the ratio in it", "[profile]") {
    const bool paired = GENERATE(false, true);
    RandomTimes random(7);
    const TwoSides times = random.sides(15, 1.3, 0.05, paired);
    const Interval first = bootstrap_interval(times);
    const Interval second = bootstrap_interval(times);
    CHECK(first.low == second.low);
    CHECK(first.high == second.high);
    CHECK(first.low < ratio_of(times));
    CHECK(first.high > ratio_of(times));
    CHECK(first.low > 1.2);
    CHECK(first.high < 1.4);
}

TEST_CASE("statistics: a bootstrap interval of equal times has no width", "[profile]") {
    const bool paired = GENERATE(false, true);
    const Interval interval = bootstrap_interval({{4, 4, 4}, {5, 5, 5}, paired});
    CHECK(interval.low == 1.25);
    CHECK(interval.high == 1.25);
}

TEST_CASE("statistics: 95 % intervals miss the truth about one time in twenty", "[profile]") {
    const bool paired = GENERATE(false, true);
    constexpr int runs = 300;
    int inside = 0;
    for (int run = 0; run < runs; ++run) {
        RandomTimes random(static_cast<std::uint64_t>(run));
        const Interval interval = bootstrap_interval(random.sides(15, 1.05, 0.03, paired));
        inside += interval.low <= 1.05 && interval.high >= 1.05 ? 1 : 0;
    }
    CHECK(inside >= runs * 91 / 100);
    CHECK(inside <= runs * 99 / 100);
}

TEST_CASE("statistics: Holm's adjustment of the textbook", "[profile]") {
    const std::vector<double> adjusted = holm_adjusted(std::vector<double>{0.01, 0.04, 0.03, 0.005});
    REQUIRE(adjusted.size() == 4);
    CHECK(adjusted[0] == Approx(0.03));
    CHECK(adjusted[1] == Approx(0.06));  // not less than the one before it
    CHECK(adjusted[2] == Approx(0.06));
    CHECK(adjusted[3] == Approx(0.02));
    CHECK(holm_adjusted(std::vector<double>{0.7, 0.9}) == std::vector<double>{1, 1});
    CHECK(holm_adjusted(std::vector<double>{}).empty());
}

}  // namespace
}  // namespace sahl::tests
