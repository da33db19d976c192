// Whether one side takes longer than the other: tests that hold for times however they are distributed.
#pragma once

#include <cstddef>

#include "engine/profile/statistics.h"

namespace sahl {

/// What a test looks for against "the other side takes `ratio` times as long".
enum class Alternative { longer, shorter, different };

/// The probability of ranks at least as extreme as those of `times` where the other side takes `ratio` times
/// as long. Of pairs: Wilcoxon's signed rank test of their quotients, for which the random order within
/// pairs is all that it assumes. Else: the rank sum test (Wilcoxon 1945, Mann and Whitney 1947), which takes
/// all repetitions as independent. Equal values share their mean rank. Exact up to 50 repetitions of both
/// sides together or 50 pairs, the normal approximation with its correction for ties beyond.
double rank_test(const TwoSides& times, Alternative alternative, double ratio = 1);

/// The least that rank_test(…, different) can give with so many repetitions: below it nothing is found.
double least_p_value(std::size_t base, std::size_t other, bool paired);

}  // namespace sahl
