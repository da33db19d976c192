#include "engine/scene/scene_format.h"

#include <algorithm>

#include <fmt/format.h>

namespace sahl {

std::optional<SceneFormat> scene_format(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".json") return SceneFormat::json;
    if (extension == ".nff") return SceneFormat::nff;
    if (extension == ".test") return SceneFormat::cse167;
    return std::nullopt;
}

std::string unknown_scene_format(const std::filesystem::path& path) {
    return fmt::format(
        "no scene format has the extension '{}'; formats are .json (Sahl scene), .nff (Neutral File Format) "
        "and .test (CSE 167)",
        path.extension().string());
}

}  // namespace sahl
