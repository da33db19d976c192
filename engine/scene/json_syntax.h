// What is wrong with a text that is no JSON, in words for the one who wrote it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sahl {

/// What a parser took last, and in what it stands.
enum class JsonAfter { start, key, value, open_object, open_array };
enum class JsonInside { file, array, object };

struct JsonSyntaxError {
    std::size_t offset = 0;
    std::string message;
};

/// The first byte that no text file in UTF-8 has.
std::optional<JsonSyntaxError> find_json_bad_byte(std::string_view text);

/// Behind white space, comments, commas and colons from `position` on.
std::size_t skip_json_separators(std::string_view text, std::size_t position);

/// What a parser refused, `position` being behind the last token that it took. The text has no bad
/// bytes.
JsonSyntaxError explain_json_error(std::string_view text, std::size_t position, JsonAfter after,
                                   JsonInside inside);

}  // namespace sahl
