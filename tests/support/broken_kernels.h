// Kernels with a mistake in them, for tests of who finds it.
#pragma once

#include <filesystem>
#include <string>

namespace sahl::tests {

/// One place of the kernels' sources, and what to put there.
struct Fault {
    std::string kernel;  ///< that computes wrongly then
    std::string file;
    std::string from;  ///< occurs once
    std::string to;
};

/// The repository's kernels into `folder`, for SAHL_KERNEL_DIR.
void copy_kernels(const std::filesystem::path& folder);

/// Throws std::runtime_error unless the file has the place exactly once.
void break_kernel(const std::filesystem::path& folder, const Fault& fault);

}  // namespace sahl::tests
