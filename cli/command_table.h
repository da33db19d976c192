// The commands and options that --help shows, for what else is made of them.
#pragma once

#include <string>
#include <vector>

#include "cli/values.h"

namespace sahl::cli {

/// All of them, those of a command behind it.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// As it is typed: "render", "profile diff".
std::string name_of(const CLI::App& command);

/// "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option);

bool takes_value(const CLI::Option& option);
bool is_repeatable(const CLI::Option& option);

std::vector<const CLI::Option*> named_options(const CLI::App& app);
std::vector<const CLI::Option*> positionals(const CLI::App& app);

}  // namespace sahl::cli
