// Scene files by their extension.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"

namespace sahl {

struct LoadOptions {
    /// Names and values of parameters of a Sahl scene that override their defaults, in its text form:
    /// `2.5`, `true`, `1,0,0`. Throws Error(usage) for what the scene has no parameter for.
    std::vector<std::pair<std::string, std::string>> parameters{};
    /// The folder that all files a scene refers to must lie in; none: the folder of the scene.
    std::optional<std::filesystem::path> asset_root{};
};

/// Reads a scene: `.json` (Sahl scene), `.nff` (Haines' Neutral File Format), `.test` (CSE 167 text
/// format).
/// Throws SceneError with file:line:column for what is wrong inside the file, Error(scene) when it
/// cannot be read and, with that file's place and the include's, for what is wrong inside an included
/// file, Error(usage) for an extension that names no format (it lists those there are), for wrong
/// parameters and for an asset root that is no folder.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace sahl
