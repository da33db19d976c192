// How far repeated measurements agree.
#pragma once

#include <span>
#include <vector>

namespace sahl {

/// For each value whether it is further from the median than three times what the median absolute
/// deviation says of a normal distribution's standard deviation, and than 1 % of the median.
std::vector<bool> find_outliers(std::span<const double> values);

/// Half the width of the 95 % confidence interval of the median, as a fraction of it: between the order
/// statistics that the binomial distribution gives, which assumes nothing of the values' distribution.
/// Infinite where there are fewer than six values, too few for such an interval.
double median_uncertainty(std::vector<double> values);

}  // namespace sahl
