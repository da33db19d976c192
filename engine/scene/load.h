// Scene files by their extension.
#pragma once

#include <filesystem>

#include "engine/scene/scene.h"

namespace sahl {

/// Reads a scene: `.nff` (Haines' Neutral File Format), `.test` (CSE 167 text format).
/// Throws SceneError with file:line:column for what is wrong inside the file, Error(scene) when it
/// cannot be read, Error(usage) for an extension that names no format (it lists those there are).
Scene load_scene(const std::filesystem::path& path);

}  // namespace sahl
