#include "cli/output_name.h"

#include <algorithm>
#include <set>

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

/// The same file under different spellings counts too.
void check_distinct(const std::vector<std::vector<std::filesystem::path>>& names) {
    std::set<std::filesystem::path> seen;
    for (const std::vector<std::filesystem::path>& of_depth : names) {
        for (const std::filesystem::path& name : of_depth) {
            std::error_code ignored;
            std::filesystem::path file = std::filesystem::weakly_canonical(name, ignored);
            if (ignored) file = name;
            if (!seen.insert(std::move(file)).second) {
                throw Error(ExitCode::usage, fmt::format("-o '{}': two images would go into this file; give "
                                                         "each a name of its own",
                                                         name.string()));
            }
        }
    }
}

}  // namespace

std::vector<std::vector<std::filesystem::path>> output_names(const std::vector<std::string>& patterns,
                                                             const std::filesystem::path& scene,
                                                             const std::vector<int>& depths) {
    for (const std::string& pattern : patterns) check_placeholders(pattern);
    const bool plain =
        patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [](const auto& text) {
            return text.find(depth_placeholder) == std::string::npos;
        });
    if (depths.size() > 1 && plain) {
        throw Error(ExitCode::usage, fmt::format("several depths need a name for each image: -o '{}_{}.png'",
                                                 scene.stem().string(), depth_placeholder));
    }
    std::vector<std::vector<std::filesystem::path>> names(depths.size());
    if (patterns.empty()) names.front().emplace_back(scene.stem().string() + ".png");
    for (std::size_t i = 0; i < depths.size(); ++i) {
        for (const std::string& pattern : patterns) names[i].emplace_back(fill_in(pattern, depths[i]));
    }
    check_distinct(names);
    return names;
}

}  // namespace sahl::cli
