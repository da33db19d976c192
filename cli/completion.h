// Scripts that complete command lines of `sahl` in shells.
#pragma once

#include <string>

#include "cli/values.h"

namespace sahl::cli {

/// For bash 4 and later; needs nothing of the package bash-completion.
std::string bash_completion(const CLI::App& app);

/// For zsh: `_sahl`, to be found in fpath or to be sourced after compinit.
std::string zsh_completion(const CLI::App& app);

}  // namespace sahl::cli
