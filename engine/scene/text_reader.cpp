#include "engine/scene/text_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace sahl {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 30;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

bool is_control(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && !is_space(c)) || byte == 0x7f;
}

[[noreturn]] void fail_unreadable(const std::filesystem::path& path, std::string_view why) {
    throw Error(ExitCode::scene, fmt::format("{}: cannot read this scene file: {}", path.string(), why));
}

// std::from_chars takes no '+'; everything it leaves over makes the word no number.
template <typename Number>
std::errc parse(std::string_view word, Number& value) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return stop == end ? error : std::errc::invalid_argument;
}

bool begins_number(std::string_view word) {
    return !word.empty() &&
           (word[0] == '+' || word[0] == '-' || word[0] == '.' || (word[0] >= '0' && word[0] <= '9'));
}

}  // namespace

std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string text = "'";
    std::size_t length = std::min(word.size(), longest);
    // Not within a character of UTF-8.
    while (length < word.size() && length > 0 &&
           (static_cast<unsigned char>(word[length]) & 0xc0U) == 0x80U) {
        --length;
    }
    for (const char c : word.substr(0, length)) text += is_control(c) ? '?' : c;
    return text + (word.size() > length ? "…'" : "'");
}

std::string read_scene_file(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        fail_unreadable(path, "there is no such file; check the path");
    }
    if (error) fail_unreadable(path, error.message());
    if (status.type() == std::filesystem::file_type::directory) {
        fail_unreadable(path, "it is a folder; name a file in it");
    }

    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) fail_unreadable(path, fmt::format("{}; check its permissions", std::strerror(errno)));
    std::string text;
    // Not by the file's size: a pipe has none.
    constexpr std::size_t chunk = std::size_t{1} << 20;
    while (file) {
        const std::size_t old_size = text.size();
        if (old_size > largest_file) fail_unreadable(path, "it is larger than 1 GiB; split the scene");
        text.resize(old_size + chunk);
        file.read(text.data() + old_size, static_cast<std::streamsize>(chunk));
        text.resize(old_size + static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad()) fail_unreadable(path, std::strerror(errno));
    return text;
}

TextReader::TextReader(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
    if (text_.starts_with("\xef\xbb\xbf")) {
        position_ = 3;
        line_start_ = 3;
    }
    int line = 1;
    std::size_t line_start = position_;
    for (std::size_t i = position_; i < text_.size(); ++i) {
        if (is_control(text_[i])) {
            throw SceneError(
                {name_, line, static_cast<int>(i - line_start) + 1},
                fmt::format("byte 0x{:02x} in what should be a text file; if this is the right file, "
                            "save it as plain text (UTF-8)",
                            static_cast<unsigned char>(text_[i])));
        }
        const bool lone_return = text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n');
        if (text_[i] == '\n' || lone_return) {
            ++line;
            line_start = i + 1;
        }
    }
    advance();
}

TextReader TextReader::from_file(const std::filesystem::path& path) {
    return TextReader(path.string(), read_scene_file(path));
}

// Finds the next word.
void TextReader::advance() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (c == '#') {
            position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
        } else if (is_space(c)) {
            ++position_;
            const bool lone_return = c == '\r' && (position_ == text_.size() || text_[position_] != '\n');
            if (c == '\n' || lone_return) {
                ++line_;
                line_start_ = position_;
            }
        } else {
            break;
        }
    }
    const std::size_t start = position_;
    while (position_ < text_.size() && !is_space(text_[position_]) && text_[position_] != '#') ++position_;
    next_.kind = start < text_.size() ? Token::Kind::word : Token::Kind::file_end;
    next_.text = std::string_view(text_).substr(start, position_ - start);
    next_.line = line_;
    next_.column = static_cast<int>(start - line_start_) + 1;

    if (bound_line_ != 0 && (next_.line != bound_line_ || at_end())) {
        after_line_ = next_;
        next_ = {Token::Kind::line_end, {}, last_line_, last_column_};
    }
}

Token TextReader::take() {
    const Token word = next_;
    if (word.kind == Token::Kind::word) {
        last_line_ = word.line;
        last_column_ = word.column + static_cast<int>(word.text.size());
        advance();
    }
    return word;
}

bool TextReader::number_follows() const { return begins_number(next_.text); }

// Messages are put together only when they are thrown: a scene has millions of numbers.
double TextReader::component(std::string_view what, std::string_view axis, Range range) {
    double value = 0;
    const std::errc error = parse(next_.text, value);
    if (error == std::errc::result_out_of_range) {
        throw SceneError(place(), fmt::format("{}{}: {} is outside the range of numbers", what, axis,
                                              in_quotes(next_.text)));
    }
    // from_chars also reads "inf", "nan" and the like.
    if (error != std::errc() || !std::isfinite(value))
        fail_expected(fmt::format("{}{}, a number", what, axis));
    if (!range.contains(value)) check_range(value, range, fmt::format("{}{}", what, axis), place());
    take();
    return value;
}

double TextReader::number(std::string_view what, Range range) { return component(what, "", range); }

long long TextReader::whole_number(std::string_view what, long long low, long long high) {
    long long value = 0;
    const std::errc error = parse(next_.text, value);
    if (error != std::errc() || value < low || value > high) {
        fail_expected(fmt::format("{}, a whole number from {} to {}", what, low, high));
    }
    take();
    return value;
}

glm::dvec3 TextReader::vector(std::string_view what) {
    glm::dvec3 v;
    v.x = component(what, " x", any_number);
    v.y = component(what, " y", any_number);
    v.z = component(what, " z", any_number);
    return v;
}

glm::vec3 TextReader::color(std::string_view what) {
    glm::dvec3 c;
    c.r = component(what, " red", not_negative);
    c.g = component(what, " green", not_negative);
    c.b = component(what, " blue", not_negative);
    return c;
}

void TextReader::bind_to_line(const Token& word) {
    bound_line_ = word.line;
    if (next_.line != bound_line_ || at_end()) {
        after_line_ = next_;
        next_ = {Token::Kind::line_end, {}, last_line_, last_column_};
    }
}

void TextReader::skip_line() {
    while (next_.kind == Token::Kind::word) take();
}

void TextReader::end_line(std::string_view command) {
    if (next_.kind == Token::Kind::word) {
        fail_expected(fmt::format("the end of the line, {} has all its values", in_quotes(command)));
    }
    bound_line_ = 0;
    next_ = after_line_;
}

std::size_t TextReader::bytes_left() const { return text_.size() - position_ + next_.text.size(); }

void TextReader::fail_expected(std::string_view what, std::string_view hint) const {
    const std::string found = next_.kind == Token::Kind::word       ? in_quotes(next_.text)
                              : next_.kind == Token::Kind::line_end ? "the end of the line"
                                                                    : "the end of the file";
    throw SceneError(place(), fmt::format("expected {}; found {}{}", what, found, hint));
}

}  // namespace sahl
