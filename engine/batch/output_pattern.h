// Names of a batch's images: "out/{scene}/{camera}/{frame:04}.exr".
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sahl {

/// Names and texts that placeholders stand for.
using PlaceholderValues = std::vector<std::pair<std::string_view, std::string>>;

struct FilledPattern {
    std::string text{};
    std::string problem{};  ///< what is wrong with the pattern; empty: nothing
};

/// `pattern` with each `{name}` replaced by its value, and each `{name:04}`, whose value has to be a whole
/// number, by that with at least so many digits, zeros in front.
FilledPattern fill_pattern(std::string_view pattern, const PlaceholderValues& values);

}  // namespace sahl
