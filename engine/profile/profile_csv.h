// A profile's rows as a table for spreadsheets.
#pragma once

#include <string>

#include "engine/profile/profile.h"

namespace sahl {

/// RFC 4180 with a line of names, then a line a kernel, variant and generation. Columns are those of the
/// JSON's rows without samples; what is not known is empty.
std::string profile_csv(const Profile& profile);

}  // namespace sahl
