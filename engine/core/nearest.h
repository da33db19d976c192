// "Did you mean": the known name nearest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sahl {

/// The name with the least edit distance (insertions, deletions, substitutions, swaps of neighbours;
/// upper and lower case count as equal), or empty if none is within a third of `name`'s length.
/// The first of several equally near ones wins.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> names);

/// `"; did you mean 'sphere'?"`, or nothing when no name is near.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);

/// The names separated by commas.
std::string join_names(std::span<const std::string_view> names);

}  // namespace sahl
