#include "bench/statistics.h"

#include <time.h>  // NOLINT: clock_gettime

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

namespace sahl::bench {

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {values.front(), median, values.back()};
}

Spread spread_of_quotients(const std::vector<double>& numerators, const std::vector<double>& denominators) {
    std::vector<double> quotients(numerators.size());
    std::transform(numerators.begin(), numerators.end(), denominators.begin(), quotients.begin(),
                   std::divides<>());
    return spread_of(std::move(quotients));
}

double geometric_mean(const std::vector<double>& values) {
    if (values.empty()) return 0;
    double sum = 0;
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / static_cast<double>(values.size()));
}

double seconds_now(Clock clock) {
    if (clock == Clock::processor) {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return (static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)) /
               std::thread::hardware_concurrency();
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace sahl::bench
