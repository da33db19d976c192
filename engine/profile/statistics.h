// Medians of repeated times, how far they can be trusted, and how many comparisons at once change that.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sahl {

/// The same work measured several times on each of two sides, in any unit, every time above 0.
struct TwoSides {
    std::vector<double> base;
    std::vector<double> other;
    /// other[i] was measured beside base[i], in an order that was drawn at random; as many of one as of the
    /// other. What moves a machine's speed for longer than that moves both, and drops out of their quotient.
    bool paired = false;
};

struct Interval {
    double low = 0;
    double high = 0;
};

/// The `q` quantile (0 to 1) of at least one value, linear between neighbours in order.
double quantile(std::span<const double> values, double q);

double median(std::span<const double> values);

/// How many times as long the other side takes: the quotient of the medians, or, of pairs, the median of
/// their quotients.
double ratio_of(const TwoSides& times);

/// The 95 % interval of ratio_of by the percentile bootstrap (Efron and Tibshirani, An Introduction to the
/// Bootstrap, ch. 13): sides, or pairs, are drawn again with replacement. The draws are always the same.
/// With fewer than some ten repetitions the interval is too narrow; the tests of rank_tests.h are exact.
Interval bootstrap_interval(const TwoSides& times);

/// P values of several tests adjusted by Holm's method (Scand. J. Statistics 6, 1979): where those at most
/// `level` are taken as findings, one of them or more is false with a probability of at most `level`, however
/// the tests depend on each other.
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace sahl
