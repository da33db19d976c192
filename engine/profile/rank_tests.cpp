#include "engine/profile/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sahl {
namespace {

constexpr std::size_t most_exact = 50;  ///< 2^50 and the binomials of 50 are exact doubles

/// Twice the ranks, from 2 on: whole numbers where equal values share their mean rank.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<std::size_t> ranks(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = begin + 1 + end;
        begin = end;
    }
    return ranks;
}

/// Shares of the equally likely outcomes with a sum of at most and of at least the observed one.
struct Tails {
    double low = 0;
    double high = 0;
};

double p_value(const Tails& tails, Alternative alternative) {
    if (alternative == Alternative::longer) return tails.high;
    if (alternative == Alternative::shorter) return tails.low;
    return std::min(1.0, 2 * std::min(tails.low, tails.high));
}

Tails tails_of(const std::vector<double>& outcomes, std::size_t observed) {
    const auto at = outcomes.begin() + static_cast<std::ptrdiff_t>(observed);
    const double all = std::accumulate(outcomes.begin(), outcomes.end(), 0.0);
    return {std::accumulate(outcomes.begin(), at + 1, 0.0) / all,
            std::accumulate(at, outcomes.end(), 0.0) / all};
}

/// Sums are doubled and lie at even or odd places alike: one unit is what continuity corrects by.
Tails normal_tails(double observed, double mean, double variance) {
    if (variance <= 0) return {1, 1};
    const auto upper = [&](double above_mean) {
        return std::erfc((above_mean - 1) / std::sqrt(2 * variance)) / 2;
    };
    return {upper(mean - observed), upper(observed - mean)};
}

/// Of the sum of those ranks that a fair coin chose, each for itself.
Tails signed_rank_tails(const std::vector<std::size_t>& ranks, std::size_t observed) {
    const std::size_t sum = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
    if (ranks.size() > most_exact) {
        double variance = 0;
        for (const std::size_t rank : ranks) variance += static_cast<double>(rank * rank) / 4;
        return normal_tails(static_cast<double>(observed), static_cast<double>(sum) / 2, variance);
    }
    std::vector<double> outcomes(sum + 1, 0);  // by their sum
    outcomes[0] = 1;
    for (const std::size_t rank : ranks) {
        for (std::size_t i = sum; i >= rank; --i) outcomes[i] += outcomes[i - rank];
    }
    return tails_of(outcomes, observed);
}

/// Of the sum of `count` of the ranks, all choices equally likely.
Tails rank_sum_tails(const std::vector<std::size_t>& ranks, std::size_t count, std::size_t observed) {
    const std::size_t sum = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
    if (ranks.size() > most_exact) {
        const auto all = static_cast<double>(ranks.size());
        const auto chosen = static_cast<double>(count);
        const double mean = static_cast<double>(sum) / all;
        double square = 0;
        for (const std::size_t rank : ranks) square += std::pow(static_cast<double>(rank) - mean, 2);
        const double variance = chosen * (all - chosen) / (all * (all - 1)) * square;
        return normal_tails(static_cast<double>(observed), chosen * mean, variance);
    }
    std::vector<std::vector<double>> outcomes(count + 1,
                                              std::vector<double>(sum + 1, 0));  // by count and sum
    outcomes[0][0] = 1;
    for (const std::size_t rank : ranks) {
        for (std::size_t chosen = count; chosen > 0; --chosen) {
            for (std::size_t i = rank; i <= sum; ++i) outcomes[chosen][i] += outcomes[chosen - 1][i - rank];
        }
    }
    return tails_of(outcomes[count], observed);
}

double signed_rank_test(const TwoSides& times, Alternative alternative, double ratio) {
    std::vector<double> distances;
    std::vector<bool> longer;
    for (std::size_t i = 0; i < times.base.size(); ++i) {
        // As products: equal times are no difference, whatever their quotient rounds to.
        if (times.other[i] == ratio * times.base[i]) continue;
        distances.push_back(std::abs(std::log(times.other[i] / (ratio * times.base[i]))));
        longer.push_back(times.other[i] > ratio * times.base[i]);
    }
    const std::vector<std::size_t> ranks = doubled_ranks(distances);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) sum += longer[i] ? ranks[i] : 0;
    return p_value(signed_rank_tails(ranks, sum), alternative);
}

double rank_sum_test(const TwoSides& times, Alternative alternative, double ratio) {
    std::vector<double> values = times.other;
    for (const double time : times.base) values.push_back(ratio * time);
    const std::vector<std::size_t> ranks = doubled_ranks(values);
    const auto end = ranks.begin() + static_cast<std::ptrdiff_t>(times.other.size());
    const std::size_t sum = std::accumulate(ranks.begin(), end, std::size_t{0});
    return p_value(rank_sum_tails(ranks, times.other.size(), sum), alternative);
}

}  // namespace

double rank_test(const TwoSides& times, Alternative alternative, double ratio) {
    return times.paired ? signed_rank_test(times, alternative, ratio)
                        : rank_sum_test(times, alternative, ratio);
}

double least_p_value(std::size_t base, std::size_t other, bool paired) {
    const TwoSides apart{std::vector<double>(base, 1), std::vector<double>(other, 2), paired};
    return rank_test(apart, Alternative::different);
}

}  // namespace sahl
