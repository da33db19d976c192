// Medians of repeated measurements, and their spread.
#pragma once

#include <vector>

namespace sahl::bench {

struct Spread {
    double min = 0, median = 0, max = 0;
};

/// Of at least one value.
Spread spread_of(std::vector<double> values);

/// The numerators over the denominators, each over its neighbour in time: what a machine's changing speed
/// moves least. As many of one as of the other.
Spread spread_of_quotients(const std::vector<double>& numerators, const std::vector<double>& denominators);

/// Of positive values; 0 where there are none.
double geometric_mean(const std::vector<double>& values);

/// Wall-clock time; or the processor time of the whole process, divided by the number of cores: what the same
/// work would take on a machine that does nothing else, about.
enum class Clock { wall, processor };

/// Seconds since some start.
double seconds_now(Clock clock = Clock::wall);

}  // namespace sahl::bench
