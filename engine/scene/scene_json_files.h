// Which file a scene means by a URI.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/scene/scene_json_state.h"

namespace sahl {

/// A file that a scene refers to.
struct SceneFile {
    std::filesystem::path shown;  ///< as messages name it
    std::filesystem::path real;   ///< without symbolic links
};

/// The file of `uri`, relative to the folder of `state`'s file. Throws SceneError at `value` for
/// absolute paths and schemes, for what is no file, and for what does not lie in the asset root once
/// all `..` and links are resolved.
SceneFile find_scene_file(const JsonSceneState& state, const JsonValue& value, std::string_view uri);

}  // namespace sahl
