// The files that PoCL compiles a program into, so that the program cache can keep them.
//
// A program binary of PoCL 3.1 would hold the same code, but asking for it makes PoCL compile
// every kernel once more, for local sizes that are never launched: longer than the first image.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace sahl {

/// Runs `build`, which has PoCL build the program that `key` stands for, and remembers the folder
/// it is compiled into. True if that is a new one: nothing was there to be used again.
/// Waits while another thread builds.
bool build_watched(const std::string& key, const std::function<void()>& build);

/// All files that the program has been compiled into so far; nothing if its folder is unknown.
std::optional<std::string> pack_compiled(const std::string& key);

/// Puts packed files where PoCL finds them at the next build of the program. Files that are there
/// stay: this process may run their code. False if they are no packed files or cannot be written.
bool unpack_compiled(const std::string& key, const std::string& packed);

/// Adds packed kernels, which another process has compiled, to those of the program that has been built.
/// Returns how many.
std::size_t add_compiled(const std::string& key, const std::string& packed);

/// Kernels that unpack_compiled() has brought into PoCL's folder.
std::size_t count_unpacked_kernels();

}  // namespace sahl
