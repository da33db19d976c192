// Program binaries kept between runs: the one cache that Sahl has.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sahl {

struct CachedProgram {
    std::string binary;                ///< the driver's, or what PoCL compiled, see pocl_programs.h
    std::vector<std::string> kernels;  ///< whose compiled work-group code is in it
    bool tested = false;               ///< they have passed the self-test
};

/// SAHL_CACHE_DIR, else XDG_CACHE_HOME/sahl, else HOME/.cache/sahl, else none.
std::optional<std::filesystem::path> cache_folder();

/// The program that was stored under `key`, the whole text of what its binary depends on (sources,
/// options, device, driver). Nothing if there is none, no cache folder, or if the file is damaged,
/// cut short, from another version of the format or another user's.
std::optional<CachedProgram> load_program(const std::string& key);

/// Stores it for later runs, all or nothing; readers and other writers are never disturbed.
/// Does nothing when there is no folder that can be written. The oldest files beyond 64 go.
void store_program(const std::string& key, const CachedProgram& program) noexcept;

}  // namespace sahl
