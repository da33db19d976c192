// A profile as a text for people.
#pragma once

#include <string>

#include "engine/sahl.h"

namespace sahl::cli {

/// At most 120 columns: what was measured, how the frames' time adds up, kernels by generation with their
/// totals, host steps.
std::string profile_text(const Profile& profile);

}  // namespace sahl::cli
