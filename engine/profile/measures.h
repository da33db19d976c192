// The rows of a profile and their totals.
#pragma once

#include <string>
#include <utility>

#include "engine/profile/profile.h"
#include "engine/profile/summarize.h"

namespace sahl {

/// Kernel and variant: "intersect_packet" is "intersect" in the variant "packet".
std::pair<std::string, std::string> split_name(const std::string& name);

/// Fills the rows and totals of `profile`, whose wall_ms and calibration are known.
void add_rows(Profile& profile, const Measurement& measurement);

}  // namespace sahl
