// How far repeated measurements agree: samples with known answers.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/profile/samples.h"

namespace sahl::tests {

TEST_CASE("samples: what lies far from the median is an outlier, the spread of the rest is none",
          "[profile]") {
    CHECK(find_outliers(std::vector<double>{10, 11, 9, 10, 40}) ==
          std::vector<bool>{false, false, false, false, true});
    CHECK(find_outliers(std::vector<double>{10, 11, 9, 12, 8}) == std::vector<bool>(5, false));
    CHECK(find_outliers(std::vector<double>{1}) == std::vector<bool>{false});
    // The same time again and again makes no outlier of one that is 0.9 % more.
    CHECK(find_outliers(std::vector<double>{100, 100, 100, 100, 100.9}) == std::vector<bool>(5, false));
    CHECK(find_outliers(std::vector<double>{100, 100, 100, 100, 101.1}).back());
}

TEST_CASE("samples: the interval of the median has the order statistics of the binomial table", "[profile]") {
    // Bounds of the 95 % interval by number of values, from 1: Conover, Practical Nonparametric Statistics.
    struct Bounds {
        std::size_t count, lower, upper;
    };
    for (const Bounds& bounds :
         {Bounds{6, 1, 6}, {8, 1, 8}, {9, 2, 8}, {11, 2, 10}, {20, 6, 15}, {50, 18, 33}}) {
        INFO(bounds.count);
        std::vector<double> values(bounds.count);
        std::iota(values.begin(), values.end(), 1.0);
        const double middle = (1.0 + static_cast<double>(bounds.count)) / 2;
        const double half_width = (static_cast<double>(bounds.upper) - static_cast<double>(bounds.lower)) / 2;
        CHECK(median_uncertainty(values) == Approx(half_width / middle));
    }
    CHECK(std::isinf(median_uncertainty({1, 1, 1, 1, 1})));
    CHECK(median_uncertainty(std::vector<double>(7, 3.0)) == 0);
}

}  // namespace sahl::tests
