// Names of the images that one command writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sahl::cli {

/// For each depth the names of its images: every pattern with `{depth}` filled in, or
/// `SCENE_STEM.png` in the current folder where there is no pattern. Throws Error(usage) for other
/// placeholders, and when two images would go into one file.
std::vector<std::vector<std::filesystem::path>> output_names(const std::vector<std::string>& patterns,
                                                             const std::filesystem::path& scene,
                                                             const std::vector<int>& depths);

}  // namespace sahl::cli
