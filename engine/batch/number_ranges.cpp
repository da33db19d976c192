#include "engine/batch/number_ranges.h"

#include <charconv>
#include <cmath>

namespace sahl {
namespace {

/// Takes a number off the front; false if there is none. Exponents are no part of it: ranges are short.
bool take_number(std::string_view& text, double& number) {
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
    if (error != std::errc() || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool take(std::string_view& text, char mark) {
    if (!text.starts_with(mark)) return false;
    text.remove_prefix(1);
    return true;
}

bool add_part(std::string_view part, std::vector<double>& numbers) {
    double first = 0;
    if (!take_number(part, first)) return false;
    double last = first;
    double step = 1;
    if (take(part, '-')) {
        if (!take_number(part, last)) return false;
        if (take(part, 'x') && (!take_number(part, step) || !(step > 0))) return false;
    }
    if (!part.empty()) return false;
    // A step such as 0.1 is no binary fraction: the last number may be missed by a hair.
    const double steps = std::floor(std::abs(last - first) / step + 1e-6);
    if (!(steps < static_cast<double>(most_range_numbers - numbers.size()))) return false;
    const double direction = last < first ? -1 : 1;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(steps); ++i)
        numbers.push_back(first + direction * static_cast<double>(i) * step);
    return true;
}

}  // namespace

std::optional<std::vector<double>> parse_ranges(std::string_view text) {
    std::vector<double> numbers;
    for (;;) {
        const std::size_t comma = text.find(',');
        if (!add_part(text.substr(0, comma), numbers)) return std::nullopt;
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace sahl
