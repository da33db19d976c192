#include "cli/output_name.h"

#include <fmt/format.h>

#include "engine/sahl.h"

namespace sahl::cli {

namespace {

constexpr std::string_view depth_placeholder = "{depth}";

/// Any `{…}` that is no placeholder of ours is a mistake, not a file name.
void check_placeholders(const std::string& pattern) {
    for (std::size_t open = pattern.find('{'); open != std::string::npos;
         open = pattern.find('{', open + 1)) {
        const std::size_t close = pattern.find('}', open);
        if (close == std::string::npos) return;
        const std::string placeholder = pattern.substr(open, close - open + 1);
        if (placeholder == depth_placeholder) continue;
        throw Error(ExitCode::usage, fmt::format("-o '{}': there is no placeholder {}; there is {}", pattern,
                                                 placeholder, depth_placeholder));
    }
}

std::string fill_in(std::string pattern, int depth) {
    const std::string text = std::to_string(depth);
    for (std::size_t at = pattern.find(depth_placeholder); at != std::string::npos;
         at = pattern.find(depth_placeholder, at + text.size())) {
        pattern.replace(at, depth_placeholder.size(), text);
    }
    return pattern;
}

}  // namespace

std::vector<std::filesystem::path> output_names(const std::optional<std::string>& pattern,
                                                const std::filesystem::path& scene,
                                                const std::vector<int>& depths) {
    if (pattern) check_placeholders(*pattern);
    if (depths.size() > 1 && (!pattern || pattern->find(depth_placeholder) == std::string::npos)) {
        throw Error(ExitCode::usage, fmt::format("several depths need a name for each image: -o '{}_{}.png'",
                                                 scene.stem().string(), depth_placeholder));
    }
    if (!pattern) return {scene.stem().string() + ".png"};
    std::vector<std::filesystem::path> names;
    names.reserve(depths.size());
    for (const int depth : depths) names.emplace_back(fill_in(*pattern, depth));
    return names;
}

}  // namespace sahl::cli
