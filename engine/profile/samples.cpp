#include "engine/profile/samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/profile/statistics.h"

namespace sahl {
namespace {

constexpr double normal_deviation = 1.4826;  // standard deviation over median absolute deviation
constexpr double outlier_deviations = 3;
constexpr double negligible = 0.01;

}  // namespace

std::vector<bool> find_outliers(std::span<const double> values) {
    const double middle = median(values);
    std::vector<double> deviations;
    for (const double value : values) deviations.push_back(std::abs(value - middle));
    const double limit =
        std::max(outlier_deviations * normal_deviation * median(deviations), negligible * std::abs(middle));
    std::vector<bool> outliers;
    for (const double deviation : deviations) outliers.push_back(deviation > limit);
    return outliers;
}

double median_uncertainty(std::vector<double> values) {
    // With k of n values below the lower bound and k above the upper one the interval misses the median
    // with a probability of twice the binomial distribution's sum up to k.
    const std::size_t n = values.size();
    double term = std::pow(0.5, static_cast<double>(n));
    double sum = term;
    std::size_t k = 0;
    if (2 * sum > 0.05) return std::numeric_limits<double>::infinity();
    for (;; ++k) {
        term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
        if (2 * (sum + term) > 0.05) break;
        sum += term;
    }
    std::sort(values.begin(), values.end());
    const double middle = median(values);
    return middle > 0 ? (values[n - 1 - k] - values[k]) / 2 / middle : 0;
}

}  // namespace sahl
