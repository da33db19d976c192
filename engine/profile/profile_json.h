// A profile as JSON: docs/sahl-profile.schema.json describes it.
#pragma once

#include <string>

#include "engine/profile/profile.h"

namespace sahl {

std::string profile_json(const Profile& profile);

}  // namespace sahl
