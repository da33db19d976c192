#include "engine/batch/output_pattern.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "engine/core/nearest.h"

namespace sahl {
namespace {

/// The number of digits in ":04"; -1 if it is no such width.
int width_of(std::string_view format) {
    int width = -1;
    const auto [end, error] = std::from_chars(format.data(), format.data() + format.size(), width);
    const bool whole = error == std::errc() && end == format.data() + format.size();
    return whole && format.starts_with('0') && width <= 64 ? width : -1;
}

std::string padded(std::string_view number, int width) {
    const bool negative = number.starts_with('-');
    const std::string_view digits = number.substr(negative ? 1 : 0);
    const auto zeros = std::max<std::ptrdiff_t>(0, width - static_cast<std::ptrdiff_t>(digits.size()));
    return (negative ? "-" : "") + std::string(static_cast<std::size_t>(zeros), '0') + std::string(digits);
}

bool is_whole(std::string_view text) {
    if (text.starts_with('-')) text.remove_prefix(1);
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string unknown(std::string_view name, const PlaceholderValues& values) {
    std::vector<std::string_view> names;
    std::string list;
    for (const auto& [known, value] : values) {
        names.push_back(known);
        list += fmt::format("{}{{{}}}", list.empty() ? "" : ", ", known);
    }
    const std::string hint = did_you_mean(name, names);
    return fmt::format("nothing here is called {{{}}}{}", name, hint.empty() ? "; there is " + list : hint);
}

}  // namespace

FilledPattern fill_pattern(std::string_view pattern, const PlaceholderValues& values) {
    FilledPattern filled;
    for (;;) {
        const std::size_t open = pattern.find('{');
        const std::size_t close = pattern.find('}', open == std::string_view::npos ? 0 : open);
        if (open == std::string_view::npos || close == std::string_view::npos) {
            filled.text += pattern;
            return filled;
        }
        filled.text += pattern.substr(0, open);
        const std::string_view inside = pattern.substr(open + 1, close - open - 1);
        const std::size_t colon = inside.find(':');
        const std::string_view name = inside.substr(0, colon);
        const auto found = std::find_if(values.begin(), values.end(),
                                        [&](const auto& value) { return value.first == name; });
        if (found == values.end()) return {{}, unknown(name, values)};
        const std::string& value = found->second;
        if (value.find('/') != std::string::npos) {
            return {{},
                    fmt::format("the value '{}' of {{{}}} is no part of a file name, for there is a / in it",
                                value, name)};
        }
        if (colon == std::string_view::npos) {
            filled.text += value;
        } else {
            const int width = width_of(inside.substr(colon + 1));
            if (width < 0)
                return {{}, fmt::format("{{{}}}: write the number of digits as {{{}:04}}", inside, name)};
            if (!is_whole(value)) {
                return {{},
                        fmt::format("{{{}}}: only whole numbers have digits in front, and the value is '{}'",
                                    inside, value)};
            }
            filled.text += padded(value, width);
        }
        pattern.remove_prefix(close + 1);
    }
}

}  // namespace sahl
