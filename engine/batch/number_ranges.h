// Lists of numbers in few words: "1-100x2,150".
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace sahl {

/// The most numbers of one list.
inline constexpr std::size_t most_range_numbers = 1'000'000;

/// The numbers of a list: parts between commas, each a number, `FIRST-LAST` in steps of 1 or
/// `FIRST-LASTxSTEP`; FIRST and LAST are both in it, LAST where a step meets it. A range may go down
/// ("10-1"). None if the text is no such list, or one of more than most_range_numbers.
std::optional<std::vector<double>> parse_ranges(std::string_view text);

}  // namespace sahl
