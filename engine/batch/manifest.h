// The manifest of a batch: which scenes, cameras, frames and parameters make which images.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/batch/batch_job.h"
#include "engine/batch/key_frames.h"
#include "engine/core/error.h"

namespace sahl {

/// A parameter's values: one or several, each as `--set` takes it, or a function of the frame.
struct BatchParameter {
    std::string name;
    std::variant<std::vector<std::string>, KeyFrames> values{};
    SourceLocation place{};
};

/// A camera of the scene by its name, or one that the manifest describes.
struct CameraPath {
    KeyFrames eye;
    KeyFrames look_at;
    KeyFrames up;
    KeyFrames fov;
    KeyFrames turn;  ///< degrees; turns the eye about the axis `up` through look_at, counter-clockwise seen
                     ///< from where `up` points to
};
struct BatchCamera {
    std::string name;
    std::optional<CameraPath> path{};
    SourceLocation place{};
};

/// One element of `jobs`: the product of all that it lists.
struct BatchEntry {
    std::vector<std::filesystem::path> scenes;
    std::optional<std::filesystem::path> asset_root{};
    std::vector<BatchCamera> cameras{};  ///< none: each scene's first
    std::vector<int> frames{};           ///< none: images have no frame
    std::vector<BatchParameter> parameters{};
    std::vector<std::vector<std::string>> zips{};  ///< parameters that change together
    ImageSettings settings{};
    std::vector<std::string> outputs{};
    SourceLocation place{};  ///< no file: the command line
};

/// Whether a file is a manifest: a JSON object with the key `jobs`. Throws SceneError for a .json file that
/// is no JSON, Error(scene) for one that cannot be read.
bool is_manifest(const std::filesystem::path& path);

/// Reads a manifest: docs/batch.md. Its paths are relative to its folder; what is returned is as they have
/// to be opened from here. Throws SceneError with file:line:column for what is wrong in it, Error(scene) if
/// it cannot be read.
std::vector<BatchEntry> read_manifest(const std::filesystem::path& path);

}  // namespace sahl
