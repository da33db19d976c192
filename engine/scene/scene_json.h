// The Sahl scene format, `.json`.
#pragma once

#include <filesystem>
#include <string>

#include "engine/scene/load.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Of rays, that a scene may ask for.
inline constexpr int json_largest_depth = 64;

/// Reads the text of the Sahl scene at `path`, which need not exist; what the scene includes is looked
/// for relative to it.
///
/// Throws SceneError (or, for what is wrong in an included file, Error(scene) with that file's place
/// and that of the include) and Error(usage) for parameters that the scene does not have or take.
Scene read_scene_json(const std::filesystem::path& path, std::string text, const LoadOptions& options = {});

}  // namespace sahl
