// Rendered images beside the oracle's.
#pragma once

#include <vector>

#include "tests/render/rendered.h"
#include "tests/support/oracle_render.h"

namespace sahl::tests {

struct Comparison {
    int compared = 0;
    int wrong = 0;
    double mean = 0;  ///< of the difference per channel
};

/// Away from edges every pixel agrees to `tolerance` (as close()); at edges either side is right.
Comparison compare(const Rendered& rendered, const oracle::Rendering& expected, double tolerance);

/// Ray counts of every generation agree to `relative`, or to the number of `undecided` pixels.
void check_counts(const RenderStatistics& statistics, const std::vector<oracle::Counts>& expected,
                  double relative, double undecided);

}  // namespace sahl::tests
