#include "engine/profile/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

namespace sahl {
namespace {

constexpr int resamples = 4000;
constexpr double outside = 0.025;  ///< of the resamples, beyond each end of the interval

/// SplitMix64 (Steele, Lea and Flood 2014): the standard's distributions differ between libraries.
class Draws {
public:
    /// From 0 to count - 1.
    std::size_t index(std::size_t count) {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9U;
        z = (z ^ z >> 27U) * 0x94d049bb133111ebU;
        return static_cast<std::size_t>(((z ^ z >> 31U) >> 32U) * count >> 32U);
    }

private:
    std::uint64_t state_ = 1;
};

void resample(const std::vector<double>& from, std::vector<double>& to, Draws& draws) {
    std::generate(to.begin(), to.end(), [&] { return from[draws.index(from.size())]; });
}

std::vector<double> quotients(const TwoSides& times) {
    std::vector<double> result(times.base.size());
    std::transform(times.other.begin(), times.other.end(), times.base.begin(), result.begin(),
                   std::divides<>());
    return result;
}

}  // namespace

double quantile(std::span<const double> values, double q) {
    std::vector<double> sorted(values.begin(), values.end());
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(sorted.begin(), nth, sorted.end());
    if (below + 1 == sorted.size()) return *nth;
    const double above = *std::min_element(nth + 1, sorted.end());
    return *nth + (place - static_cast<double>(below)) * (above - *nth);
}

double median(std::span<const double> values) { return quantile(values, 0.5); }

double ratio_of(const TwoSides& times) {
    return times.paired ? median(quotients(times)) : median(times.other) / median(times.base);
}

Interval bootstrap_interval(const TwoSides& times) {
    Draws draws;
    std::vector<double> ratios(resamples);
    if (times.paired) {
        const std::vector<double> pairs = quotients(times);
        std::vector<double> drawn(pairs.size());
        for (double& ratio : ratios) {
            resample(pairs, drawn, draws);
            ratio = median(drawn);
        }
    } else {
        TwoSides drawn{std::vector<double>(times.base.size()), std::vector<double>(times.other.size())};
        for (double& ratio : ratios) {
            resample(times.base, drawn.base, draws);
            resample(times.other, drawn.other, draws);
            ratio = ratio_of(drawn);
        }
    }
    return {quantile(ratios, outside), quantile(ratios, 1 - outside)};
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
    std::vector<std::size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const double scaled = static_cast<double>(order.size() - i) * p_values[order[i]];
        largest = std::min(1.0, std::max(largest, scaled));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

}  // namespace sahl
