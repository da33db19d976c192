// The rows of a profile and their totals.
#pragma once

#include "engine/profile/profile.h"
#include "engine/profile/summarize.h"

namespace sahl {

/// Fills the rows and totals of `profile`, whose wall_ms and calibration are known.
void add_rows(Profile& profile, const Measurement& measurement);

}  // namespace sahl
