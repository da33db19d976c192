#include "engine/scene/json_syntax.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/nearest.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

constexpr std::string_view word_ends = " \t\r\n,:[]{}\"/";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Bytes of the UTF-8 character at `position`, 0 if there is none (RFC 3629).
std::size_t utf8_length(std::string_view text, std::size_t position) {
    const auto byte = [&](std::size_t i) {
        return position + i < text.size() ? static_cast<unsigned char>(text[position + i]) : 0U;
    };
    const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
    const unsigned lead = byte(0);
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead <= 0xdf) return follows(1) ? 2 : 0;
    if (lead >= 0xe0 && lead <= 0xef) {
        const bool overlong = lead == 0xe0 && byte(1) < 0xa0;
        const bool surrogate = lead == 0xed && byte(1) > 0x9f;
        return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (lead >= 0xf0 && lead <= 0xf4) {
        const bool overlong = lead == 0xf0 && byte(1) < 0x90;
        const bool too_large = lead == 0xf4 && byte(1) > 0x8f;
        return follows(1) && follows(2) && follows(3) && !overlong && !too_large ? 4 : 0;
    }
    return 0;
}

// Behind white space and comments; at the start of a comment that does not end.
std::size_t skip_blank(std::string_view text, std::size_t position) {
    while (position < text.size()) {
        const std::string_view rest = text.substr(position);
        if (rest[0] == ' ' || rest[0] == '\t' || rest[0] == '\r' || rest[0] == '\n') {
            ++position;
        } else if (rest.starts_with("//")) {
            position += std::min(rest.find_first_of("\r\n"), rest.size());
        } else if (rest.starts_with("/*")) {
            const std::size_t end = rest.find("*/", 2);
            if (end == std::string_view::npos) return position;
            position += end + 2;
        } else {
            break;
        }
    }
    return position;
}

// The run of characters that were meant as one word.
std::string_view word_at(std::string_view text, std::size_t position) {
    const std::size_t end = std::min(text.find_first_of(word_ends, position), text.size());
    return text.substr(position, std::max<std::size_t>(end - position, 1));
}

std::string found(std::string_view text, std::size_t position) {
    if (position >= text.size()) return "found the end of the file";
    if (text[position] != '"') return "found " + in_quotes(word_at(text, position));
    const std::size_t end = text.find_first_of("\"\r\n", position + 1);
    return fmt::format("found the string {}", in_quotes(text.substr(position + 1, end - position - 1)));
}

bool is_json_number(std::string_view word) {
    std::size_t i = word.starts_with('-') ? 1 : 0;
    const auto digits = [&] {
        const std::size_t start = i;
        while (i < word.size() && is_digit(word[i])) ++i;
        return i - start;
    };
    const std::size_t start = i;
    const std::size_t whole = digits();
    if (whole == 0 || (whole > 1 && word[start] == '0')) return false;
    if (i < word.size() && word[i] == '.') {
        ++i;
        if (digits() == 0) return false;
    }
    if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
        ++i;
        if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
        if (digits() == 0) return false;
    }
    return i == word.size();
}

std::size_t hex_digits(std::string_view text) {
    return std::min(text.find_first_not_of("0123456789abcdefABCDEF"), text.size());
}

// The string at `start`, its opening quote, is broken.
JsonSyntaxError explain_string(std::string_view text, std::size_t start) {
    for (std::size_t i = start + 1; i < text.size() && text[i] != '"'; ++i) {
        if (text[i] == '\r' || text[i] == '\n') break;
        if (text[i] == '\t') return {i, "a tab in a string; write \\t"};
        if (text[i] != '\\') continue;
        const char escape = i + 1 < text.size() ? text[i + 1] : '\0';
        if (escape == 'u') {
            const std::string_view digits = text.substr(i + 2, 4);
            if (digits.size() < 4 || hex_digits(digits) < 4) {
                return {i, "\\u in a string needs four hexadecimal digits, such as \\u00e9"};
            }
            const bool high = (digits[0] == 'd' || digits[0] == 'D') && digits[1] >= '8';
            const std::string_view second = text.substr(std::min(i + 6, text.size()), 6);
            const bool paired = second.size() == 6 && second.starts_with("\\u") &&
                                (second[2] == 'd' || second[2] == 'D') && hex_digits(second.substr(2)) == 4 &&
                                std::string_view("cdefCDEF").find(second[3]) != std::string_view::npos;
            const bool first_half =
                high && std::string_view("89abAB").find(digits[1]) != std::string_view::npos;
            if (high && !(first_half && paired)) {
                return {i, "half a character: \\ud800 to \\udfff come in pairs; write the character itself"};
            }
            if (high) i += 6;
            i += 5;
        } else if (std::string_view("\"\\/bfnrt").find(escape) == std::string_view::npos || escape == '\0') {
            return {i, fmt::format("unknown escape {}in a string; a backslash itself is written \\\\",
                                   i + 1 < text.size() && static_cast<unsigned char>(escape) > ' '
                                       ? in_quotes(text.substr(i, 1 + utf8_length(text, i + 1))) + " "
                                       : "")};
        } else {
            ++i;
        }
    }
    return {start, "this string does not end on its line; close it with \""};
}

JsonSyntaxError no_number(std::size_t position, std::string_view word) {
    return {position, fmt::format("{} is no number; numbers look like 0.5, -2 or 1e-3", in_quotes(word))};
}

JsonSyntaxError explain_value(std::string_view text, std::size_t position, std::string_view expected) {
    const char c = position < text.size() ? text[position] : '\0';
    if (c == '"') return explain_string(text, position);
    if (c == '\'') return {position, "found a single quote; strings stand in double quotes"};
    const std::string_view word = word_at(text, std::min(position, text.size()));
    if (is_digit(c) || c == '-' || c == '+' || c == '.') {
        if (is_json_number(word)) {
            return {position, fmt::format("{} is outside the range of numbers", in_quotes(word))};
        }
        return no_number(position, word);
    }
    constexpr std::array<std::string_view, 3> literals = {"true", "false", "null"};
    return {position, fmt::format("expected {}; {}{}", expected, found(text, position),
                                  position < text.size() ? did_you_mean(word, literals) : std::string())};
}

JsonSyntaxError explain_key(std::string_view text, std::size_t position, std::string_view expected) {
    if (position < text.size() && text[position] == '"') return explain_string(text, position);
    return {position, fmt::format("expected {}; {}", expected, found(text, position))};
}

}  // namespace

std::optional<JsonSyntaxError> find_json_bad_byte(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const bool control = byte < 0x20 && byte != '\t' && byte != '\r' && byte != '\n';
        if (control || byte == 0x7f) {
            return JsonSyntaxError{i, fmt::format("byte 0x{:02x} in what should be a text file; if this is "
                                                  "the right file, save it as plain text (UTF-8)",
                                                  byte)};
        }
        const std::size_t length = utf8_length(text, i);
        if (length == 0) {
            return JsonSyntaxError{
                i, fmt::format("byte 0x{:02x} is no UTF-8 here; save the file as UTF-8", byte)};
        }
        i += length;
    }
    return std::nullopt;
}

std::size_t skip_json_separators(std::string_view text, std::size_t position) {
    for (;;) {
        position = skip_blank(text, position);
        if (position >= text.size() || (text[position] != ',' && text[position] != ':')) return position;
        ++position;
    }
}

JsonSyntaxError explain_json_error(std::string_view text, std::size_t position, JsonAfter after,
                                   JsonInside inside) {
    std::size_t at = skip_blank(text, position);
    const auto here = [&] { return at < text.size() ? text[at] : '\0'; };
    const auto endless_comment = [&] { return text.substr(std::min(at, text.size())).starts_with("/*"); };
    const JsonSyntaxError endless{at, "this comment does not end; close it with */"};
    if (endless_comment()) return endless;

    // What stands between two values, then what should follow it.
    const std::size_t separator = at;
    if (after == JsonAfter::key) {
        if (here() != ':') return {at, "expected ':' behind the key; " + found(text, at)};
        at = skip_blank(text, at + 1);
    } else if (after == JsonAfter::value && inside != JsonInside::file) {
        // A number such as 01 was taken for 0 with something behind it.
        const std::size_t start = text.find_last_of(word_ends, position - 1) + 1;
        const std::string_view last = word_at(text, start);
        if (start < position && (is_digit(last[0]) || last[0] == '-') && !is_json_number(last)) {
            return no_number(start, last);
        }
        const char close = inside == JsonInside::array ? ']' : '}';
        if (here() != ',') return {at, fmt::format("expected ',' or '{}'; {}", close, found(text, at))};
        at = skip_blank(text, at + 1);
        if (here() == close) {
            return {separator, fmt::format("nothing follows this comma but '{}'; remove it", close)};
        }
    }
    if (endless_comment()) return {at, endless.message};
    if (after == JsonAfter::value && inside == JsonInside::file) {
        return {at, "expected the end of the file; " + found(text, at)};
    }
    if (after == JsonAfter::open_object) return explain_key(text, at, "a key in double quotes or '}'");
    if (after == JsonAfter::value && inside == JsonInside::object) {
        return explain_key(text, at, "a key in double quotes");
    }
    return explain_value(text, at, after == JsonAfter::open_array ? "a value or ']'" : "a value");
}

}  // namespace sahl
