#include <catch2/catch.hpp>

#include <clocale>
#include <locale>
#include <string>
#include <vector>

#include "engine/scene/text_reader.h"

namespace sahl::tests {
namespace {

std::string message_of(const std::string& text) {
    try {
        TextReader reader("f", text);
        reader.number("n");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

struct Place {
    int line, column;
    std::string text;
    bool operator==(const Place&) const = default;
};

std::vector<Place> words_of(const std::string& text) {
    TextReader reader("f", text);
    std::vector<Place> words;
    while (!reader.at_end()) {
        const Token word = reader.take();
        words.push_back({word.line, word.column, std::string(word.text)});
    }
    return words;
}

}  // namespace

TEST_CASE("Numbers of scene files", "[scene]") {
    const auto [text, value] = GENERATE(table<std::string, double>({
        {"0", 0.0},
        {"-0", 0.0},
        {"1", 1.0},
        {"+1", 1.0},
        {"-.5", -0.5},
        {".5", 0.5},
        {"+.5", 0.5},
        {"5.", 5.0},
        {"1e3", 1000.0},
        {"1E+3", 1000.0},
        {"-2.5e-1", -0.25},
        {"007", 7.0},
        {"0.1", 0.1},
        {"1e15", 1e15},
        {"-1e15", -1e15},
        {"5.14416e-18", 5.14416e-18},
        {"1e-300", 1e-300},
    }));
    TextReader reader("f", text);
    CHECK(reader.number_follows());
    CHECK(reader.number("n") == value);
    CHECK(reader.at_end());
}

TEST_CASE("What is no number is refused at its place", "[scene]") {
    const auto word = GENERATE(as<std::string>(), "abc", "1.0abc", "0x10", "nan", "inf", "-inf", "+inf",
                               "infinity", "NAN", "1e", "+", "-", ".", "--1", "+-1", "++1", "1,5", "1_0",
                               "1e999", "-1e999", "1e-999", "1.1e15", "-1e16", "١");
    INFO(word);
    const std::string message = message_of("\n  " + word + "\n");
    CHECK_THAT(message, Catch::Contains("f:2:3: "));
    CHECK_THAT(message, Catch::Contains("n"));
}

TEST_CASE("Whole numbers of scene files", "[scene]") {
    const auto read = [](const std::string& text) {
        TextReader reader("f", text);
        return reader.whole_number("n", 1, 100);
    };
    CHECK(read("1") == 1);
    CHECK(read("+100") == 100);
    for (const std::string bad : {"0", "101", "-1", "1.0", "1e1", "x", "", "99999999999999999999999"}) {
        INFO(bad);
        CHECK_THROWS_AS(read(bad), SceneError);
    }
}

TEST_CASE("Words have the line and column of their first byte", "[scene]") {
    const std::vector<Place> expected = {{1, 1, "a"}, {1, 4, "b"}, {3, 2, "c"}, {4, 1, "d"}};
    CHECK(words_of("a\t b\n\n c# x y\nd") == expected);
    CHECK(words_of("a\t b\r\n\r\n c# x y\r\nd\r\n") == expected);
    CHECK(words_of("a\t b\r\r c# x y\rd") == expected);
    CHECK(words_of("\xef\xbb\xbf"
                   "a\t b\n\n c\nd\n") == expected);
    // ä has two bytes.
    CHECK(words_of("\xc3\xa4 b") == std::vector<Place>{{1, 1, "\xc3\xa4"}, {1, 4, "b"}});
    CHECK(words_of("# only a comment").empty());
    CHECK(words_of("").empty());
    CHECK(words_of("\xef\xbb\xbf").empty());
}

TEST_CASE("A comma locale changes no number", "[scene]") {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
    };
    // Streams follow the C++ locale, strtod and printf the C locale.
    const std::locale old = std::locale::global(std::locale(std::locale(), new Comma));
    const std::string old_c = std::setlocale(LC_ALL, nullptr);
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "pl_PL.UTF-8"})
        std::setlocale(LC_ALL, name);
    TextReader reader("f", "0.75 1500.5 1,5");
    CHECK(reader.number("n") == 0.75);
    CHECK(reader.number("n") == 1500.5);
    CHECK_THROWS_WITH(reader.number("n"), "f:1:13: expected n, a number; found '1,5'");
    TextReader outside("f", "0.5");
    CHECK_THROWS_WITH(outside.number("n", Range{1500.5, 2500.5}),
                      "f:1:1: n must be at least 1500.5 and at most 2500.5, not 0.5");
    std::setlocale(LC_ALL, old_c.c_str());
    std::locale::global(old);
}

TEST_CASE("Bytes that no text has are refused at their place", "[scene]") {
    using namespace std::string_literals;
    for (const std::string& text : {"s 1\n\0 2"s, "s 1\r\n\x01"s, "s 1\n\x7f"s, "# a\n\x1b[0m"s}) {
        CHECK_THROWS_WITH(TextReader("f", text), Catch::StartsWith("f:2:1: byte 0x"));
    }
    // UTF-16 with its byte order mark.
    CHECK_THROWS_WITH(TextReader("f", "\xff\xfes\0"s),
                      Catch::Contains("f:1:4: byte 0x00") && Catch::Contains("UTF-8"));
}

TEST_CASE("A bound line ends where it ends", "[scene]") {
    TextReader reader("f", "a 1 2 # c\nb 3");
    const Token a = reader.take();
    reader.bind_to_line(a);
    CHECK(reader.number("n") == 1);
    CHECK(reader.number("n") == 2);
    CHECK(reader.peek().kind == Token::Kind::line_end);
    CHECK_THROWS_WITH(reader.number("n"), "f:1:6: expected n, a number; found the end of the line");
    reader.end_line("a");
    CHECK(reader.take().text == "b");
    CHECK(reader.number("n") == 3);
    CHECK_THROWS_WITH(reader.number("n"), "f:2:4: expected n, a number; found the end of the file");
}

TEST_CASE("Words in messages are short and without control characters", "[scene]") {
    CHECK(in_quotes("abc") == "'abc'");
    CHECK(in_quotes("a\x1b[0m") == "'a?[0m'");
    CHECK(in_quotes(std::string(100, 'x')) == "'" + std::string(40, 'x') + "…'");
}

}  // namespace sahl::tests
