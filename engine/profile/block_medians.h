// Many pairs of times that may share what makes one side faster, taken as one.
#pragma once

#include <array>

#include "engine/profile/profile_times.h"

namespace sahl {

/// Appends one time of each row and side to `all`, which is empty before the first block: of the base the
/// median over the pairs of `block`, of the other side that times the median of the pairs' quotients, so that
/// the quotient of a block's times is the median of its pairs'. Rows of one side alone have its median.
void append_block(std::array<ProfileTimes, 2>& all, const std::array<ProfileTimes, 2>& block);

}  // namespace sahl
