// A film on disk, for a render that may be ended before it is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/film/film.h"

namespace sahl {

/// Writes what a film has after its first `samples` camera samples, exactly. `job` says what image it is of
/// (40 characters). As write_file: the file is the old or the new one. Throws Error(output).
void write_checkpoint(const std::filesystem::path& path, const std::string& job, std::uint64_t samples,
                      const Film& film);

/// Fills `film` as it was and returns the number of camera samples in it; nothing, and an empty film, where
/// there is no checkpoint of this job and size, or a damaged one.
std::optional<std::uint64_t> read_checkpoint(const std::filesystem::path& path, const std::string& job,
                                             Film& film);

}  // namespace sahl
