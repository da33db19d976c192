// What PoCL reads from the environment, set before the process's first OpenCL call, and the
// private folder that it compiles into.
#pragma once

#include <cstddef>
#include <filesystem>

namespace sahl {

/// Call before every first use of OpenCL; only the first call in a process does something.
/// Sets POCL_CACHE_DIR to a folder in a new one of this process (mode 0700, below TMPDIR or /tmp), removed
/// at exit: PoCL's own cache is shared between racing processes, and code that is damaged there is
/// run all the same. Folders that dead processes left are removed too. `threads` > 0 becomes
/// POCL_MAX_PTHREAD_COUNT.
/// Throws Error(device) when there is no place to write and execute files or the limit of their size
/// (RLIMIT_FSIZE) is too low, for PoCL would end the process.
void prepare_pocl(int threads);

/// What PoCL compiles into; after prepare_pocl().
const std::filesystem::path& pocl_folder();

/// The private folder around it.
const std::filesystem::path& private_temporary_folder();

/// Compiled kernels in PoCL's folder (one shared object each; those that came from the program
/// cache count too).
std::size_t count_compiled_kernels();

}  // namespace sahl
