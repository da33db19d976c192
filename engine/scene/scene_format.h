// The formats of scene files and their extensions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace sahl {

enum class SceneFormat { json, nff, cse167 };

/// By the extension, in upper or lower case.
std::optional<SceneFormat> scene_format(const std::filesystem::path& path);

/// What to say of a path with another extension.
std::string unknown_scene_format(const std::filesystem::path& path);

}  // namespace sahl
