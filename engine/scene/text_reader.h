// The words of a text scene file with their places: the one tokenizer of the text formats.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "engine/core/error.h"
#include "engine/scene/validate.h"

namespace sahl {

/// A word of the file, or its end, or the end of the line that the reader is bound to.
struct Token {
    enum class Kind { word, line_end, file_end };
    Kind kind = Kind::file_end;
    std::string_view text;  ///< points into the reader's text
    int line = 1;
    int column = 1;
};

/// Reads words separated by white space; `#` starts a comment to the end of its line. Lines end in
/// LF, CR LF or CR. A byte order mark is skipped and has no column. Numbers do not depend on the
/// locale: decimal, with an optional sign and exponent.
/// All errors of a file's content are SceneError at their place; a message says what was expected
/// and what was found.
class TextReader {
public:
    /// `name` is the file in messages. Throws SceneError for bytes that no text file has.
    TextReader(std::string name, std::string text);

    /// Reads the whole file. Throws Error(scene) with the path if it cannot be read.
    static TextReader from_file(const std::filesystem::path& path);

    TextReader(const TextReader&) = delete;
    TextReader& operator=(const TextReader&) = delete;

    const Token& peek() const { return next_; }
    Token take();
    bool at_end() const { return next_.kind == Token::Kind::file_end; }

    /// Whether the next word begins like a number.
    bool number_follows() const;

    /// A number in `range`; `what` names it in messages.
    double number(std::string_view what, Range range = any_number);
    /// A whole number, low..high.
    long long whole_number(std::string_view what, long long low, long long high);
    /// Three numbers, x y z.
    glm::dvec3 vector(std::string_view what);
    /// Three numbers that are not negative, red green blue.
    glm::vec3 color(std::string_view what);

    /// From now on the end of the line of `word`, just taken, is an end: what is missing is missing there.
    void bind_to_line(const Token& word);
    /// Skips the words that are left on the bound line.
    void skip_line();
    /// Releases the bound line. Throws if a word is left on it; `command` had all its values.
    void end_line(std::string_view command);

    /// Bytes of the file that are still to come, the next word included.
    std::size_t bytes_left() const;

    SourceLocation place(const Token& token) const { return {name_, token.line, token.column}; }
    /// The next word's place.
    SourceLocation place() const { return place(next_); }
    /// Throws "expected `what`; found …`hint`" at the next word.
    [[noreturn]] void fail_expected(std::string_view what, std::string_view hint = {}) const;

private:
    void advance();
    double component(std::string_view what, std::string_view axis, Range range);

    std::string name_;
    std::string text_;
    std::size_t position_ = 0;    // behind the next word
    std::size_t line_start_ = 0;  // where the line of position_ starts
    int line_ = 1;                // of position_
    Token next_;
    int bound_line_ = 0;  // 0: none
    Token after_line_;    // the word behind the bound line while next_ is its end
    int last_line_ = 1;   // the end of the word taken last
    int last_column_ = 1;
};

/// The bytes of a file, at most 1 GiB. Throws Error(scene) with the path if it cannot be read.
std::string read_scene_file(const std::filesystem::path& path);

/// A word for a message: in quotes, shortened, without control characters.
std::string in_quotes(std::string_view word);

}  // namespace sahl
