// Names of the images that one command writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sahl::cli {

/// The name of each depth's image: `pattern` with `{depth}` filled in, or `SCENE_STEM.png` in the
/// current folder. Throws Error(usage) for other placeholders, and when several depths would go
/// into one file.
std::vector<std::filesystem::path> output_names(const std::optional<std::string>& pattern,
                                                const std::filesystem::path& scene,
                                                const std::vector<int>& depths);

}  // namespace sahl::cli
