// JSON text as a person would lay it out: what is short stands on one line.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/write_text.h"

namespace sahl {

/// A JSON value on its way to text.
class JsonLayout {
public:
    enum class Lines {
        few,   ///< one if it fits, else one for each part
        each,  ///< one for each part
        full,  ///< as many parts on a line as fit
    };

    /// A value that is its text: a number, `true`, a short vector.
    JsonLayout(std::string text) : text_(std::move(text)), width_(text_.size()) {}  // NOLINT: converts

    static JsonLayout object(Lines lines = Lines::few) { return {'{', '}', lines}; }
    static JsonLayout array(Lines lines = Lines::few) { return {'[', ']', lines}; }

    /// Appends a member to an object, or with an empty key an element to an array.
    void add(std::string_view key, JsonLayout value);
    bool empty() const { return parts_.empty(); }

    /// The text, lines indented by two spaces a level, without a line end behind it.
    std::string text() const;

private:
    JsonLayout(char open, char close, Lines lines) : open_(open), close_(close), lines_(lines), width_(2) {}
    void print(std::string& out, std::size_t indent, std::size_t column) const;
    void print_line(std::string& out) const;

    std::string text_{};
    char open_ = 0;  // 0: only text_
    char close_ = 0;
    Lines lines_ = Lines::few;
    std::vector<std::pair<std::string, JsonLayout>> parts_{};  // keys with quotes and colon
    std::size_t width_;                                        // on one line
};

/// `text` in quotes, escaped.
std::string json_string(std::string_view text);

/// The shortest text that is read as the same number. JSON's -0 is a whole number, and 0 to most
/// readers: negative zero is -0.0.
template <class Number>
std::string json_number(Number x) {
    return x == 0 && std::signbit(x) ? "-0.0" : decimal(x);
}

/// "[x, y, z]" of a GLM vector.
template <class Vector>
std::string json_vector(const Vector& v) {
    std::string text = "[";
    for (int i = 0; i < v.length(); ++i) text += (i > 0 ? ", " : "") + json_number(v[i]);
    return text + "]";
}

}  // namespace sahl
