// The manual page sahl(1).
#pragma once

#include <string>

#include "cli/values.h"

namespace sahl::cli {

/// In roff with the macros of man(7).
std::string man_page(const CLI::App& app);

}  // namespace sahl::cli
