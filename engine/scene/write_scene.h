// Scenes into files, by their extension.
#pragma once

#include <filesystem>

#include "engine/scene/scene.h"

namespace sahl {

/// Throws Error(usage) that lists the formats unless the extension of `path` names one that scenes
/// are written in (`.json`, `.nff`, `.test`), Error(output) if it can be seen beforehand that `path`
/// cannot be written. Changes nothing.
void check_scene_output(const std::filesystem::path& path);

/// Writes a scene as `.json` (Sahl scene), `.nff` (Haines' Neutral File Format) or `.test` (CSE 167
/// text format) so that load_scene() gives the same scene again; the file is whole or not there.
/// Throws Error(scene) for what the format cannot express, Error(usage) for an extension that names
/// no format, Error(output) when the file cannot be written.
void write_scene(const std::filesystem::path& path, const Scene& scene);

}  // namespace sahl
