// What `sahl profile` is asked to do.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/render_options.h"

namespace sahl::cli {

/// Two settings to be measured in turn; none: one profile.
struct AbOptions {
    std::vector<std::string> settings;
    std::vector<SlowdownLimit> limits;
};

/// AOVs that a page shows.
inline constexpr std::array costs_of_page{Aov::cost_rays, Aov::cost_nodes};

struct ProfileOptions {
    RenderOptions render;       ///< of it the scene, the image, the tree and the limit of memory
    std::optional<int> repeat;  ///< nothing: until the median is sure
    int warm_up = 1;
    bool assert_no_jit = false;
    std::optional<std::string> json;  ///< files to write
    std::optional<std::string> csv;
    std::optional<std::string> trace;
    std::optional<std::string> html;
    AbOptions ab;
};

/// `options` has to outlive `command`.
void add_profile_options(CLI::App& command, ProfileOptions& options);

}  // namespace sahl::cli
