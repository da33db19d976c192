#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "engine/scene/json_document.h"

namespace sahl::tests {
namespace {

std::string place_text(const SourceLocation& place) {
    return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

}  // namespace

TEST_CASE("A JSON document keeps values, their order and their places", "[json]") {
    const JsonDocument document("a.json",
                                "\xef\xbb\xbf{ // comment, with: [signs]\r\n"
                                "  \"b\" /* \" */ : [1, -2.5e1,\r 18446744073709551616, true,\n"
                                "\tfalse, null],\"a\":{\"\\u00e4\\n\":\"x\\\"y\"} , \"ö\":\"\"}\n");
    const JsonValue& root = document.root();
    REQUIRE(root.kind == JsonKind::object);
    CHECK(place_text(document.place(root)) == "a.json:1:1");
    const auto members = document.members(root);
    REQUIRE(members.size() == 3);
    CHECK(members[0].key == "b");
    CHECK(members[1].key == "a");
    CHECK(members[2].key == "ö");
    CHECK(place_text(document.place(members[0])) == "a.json:2:3");

    REQUIRE(members[0].value.kind == JsonKind::array);
    CHECK(place_text(document.place(members[0].value)) == "a.json:2:17");
    const auto elements = document.elements(members[0].value);
    REQUIRE(elements.size() == 6);
    CHECK(elements[0].number == 1);
    CHECK(place_text(document.place(elements[0])) == "a.json:2:18");
    CHECK(elements[1].number == -25);
    CHECK(place_text(document.place(elements[1])) == "a.json:2:21");
    CHECK(elements[2].number == 18446744073709551616.0);
    CHECK(place_text(document.place(elements[2])) == "a.json:3:2");  // behind a lone CR
    CHECK(elements[3].kind == JsonKind::boolean);
    CHECK(elements[3].number == 1);
    CHECK(elements[4].kind == JsonKind::boolean);
    CHECK(elements[4].number == 0);
    CHECK(place_text(document.place(elements[4])) == "a.json:4:2");
    CHECK(elements[5].kind == JsonKind::null);

    const auto inner = document.members(members[1].value);
    REQUIRE(inner.size() == 1);
    CHECK(inner[0].key == "ä\n");
    REQUIRE(inner[0].value.kind == JsonKind::text);
    CHECK(document.text(inner[0].value) == "x\"y");
    CHECK(place_text(document.place(inner[0])) == "a.json:4:20");
    CHECK(place_text(document.place(inner[0].value)) == "a.json:4:31");
    // Columns count bytes: ö has two.
    CHECK(place_text(document.place(members[2])) == "a.json:4:41");
    CHECK(place_text(document.place(members[2].value)) == "a.json:4:46");
}

TEST_CASE("A number's end is no part of what follows", "[json]") {
    for (const std::string text : {"[1/**/,2]", "[1,2]", "[1 ,2]", "[1//\n,2]", "[1\t,2]"}) {
        INFO(text);
        const JsonDocument document("a.json", text);
        const auto elements = document.elements(document.root());
        REQUIRE(elements.size() == 2);
        CHECK(elements[1].number == 2);
        const SourceLocation place = document.place(elements[1]);
        const std::size_t offset = text.find('2');
        const std::size_t line_start = text.rfind('\n', offset);
        CHECK(place.line == (line_start == std::string::npos ? 1 : 2));
        CHECK(place.column ==
              static_cast<int>(line_start == std::string::npos ? offset + 1 : offset - line_start));
    }
    CHECK(JsonDocument("a.json", "7").root().number == 7);
}

TEST_CASE("What is no JSON is refused at its place in our own words", "[json]") {
    struct Case {
        std::string text;
        std::string place;
        std::string says;
    };
    const std::string deep(101, '[');
    const std::vector<Case> cases = {
        {"", "1:1", "expected a value; found the end of the file"},
        {" // nothing\n ", "2:2", "expected a value; found the end of the file"},
        {"{} {}", "1:4", "expected the end of the file; found '{'"},
        {"{}\n,", "2:1", "expected the end of the file; found ','"},
        {"nul", "1:1", "expected a value; found 'nul'; did you mean 'null'?"},
        {"[True]", "1:2", "expected a value or ']'; found 'True'; did you mean 'true'?"},
        {"[1, nan]", "1:5", "expected a value; found 'nan'"},
        {"[1,]", "1:3", "nothing follows this comma but ']'; remove it"},
        {"[1,\n // end\n]", "1:3", "nothing follows this comma but ']'"},
        {"{\"a\": 1,}", "1:8", "nothing follows this comma but '}'; remove it"},
        {"[1,,2]", "1:4", "expected a value; found ','"},
        {"[,1]", "1:2", "expected a value or ']'; found ','"},
        {"[1 2]", "1:4", "expected ',' or ']'; found '2'"},
        {"[1}", "1:3", "expected ',' or ']'; found '}'"},
        {"[[1], [2", "1:9", "expected ',' or ']'; found the end of the file"},
        {"{\"a\": 1 \"b\": 2}", "1:9", "expected ',' or '}'; found the string 'b'"},
        {"{\"a\" 1}", "1:6", "expected ':' behind the key; found '1'"},
        {"{\"a\": }", "1:7", "expected a value; found '}'"},
        {"{a: 1}", "1:2", "expected a key in double quotes or '}'; found 'a'"},
        {"{\"a\": 1, b: 2}", "1:10", "expected a key in double quotes; found 'b'"},
        {"{1: 2}", "1:2", "expected a key in double quotes or '}'; found '1'"},
        {"{'a': 2}", "1:2", "expected a key in double quotes or '}'; found ''a''"},
        {"['a']", "1:2", "found a single quote; strings stand in double quotes"},
        {"{", "1:2", "expected a key in double quotes or '}'; found the end of the file"},
        {"{\"a\"", "1:5", "expected ':' behind the key; found the end of the file"},
        {"{\"a\":", "1:6", "expected a value; found the end of the file"},
        {"[1e999]", "1:2", "'1e999' is outside the range of numbers"},
        {"[0, -1e400]", "1:5", "'-1e400' is outside the range of numbers"},
        {"[" + std::string(400, '9') + "]", "1:2", "is outside the range of numbers"},
        {"[01]", "1:2", "'01' is no number; numbers look like"},
        {"[.5]", "1:2", "'.5' is no number; numbers look like 0.5"},
        {"[+1]", "1:2", "'+1' is no number"},
        {"[1.]", "1:2", "'1.' is no number"},
        {"[1e]", "1:2", "'1e' is no number"},
        {"[-]", "1:2", "'-' is no number"},
        {"[0x10]", "1:2", "'0x10' is no number"},
        {"[1, \"abc]\n", "1:5", "this string does not end on its line"},
        {"[\"a\nb\"]", "1:2", "this string does not end on its line; close it with \""},
        {"{\"a: 1}", "1:2", "this string does not end on its line"},
        {"[\"a\tb\"]", "1:4", "a tab in a string; write \\t"},
        {"[\"a\\x\"]", "1:4", "unknown escape '\\x' in a string"},
        {"[\"a\\ä\"]", "1:4", "unknown escape '\\ä' in a string"},
        {"[\"\\u12g4\"]", "1:3", "needs four hexadecimal digits"},
        {"[\"\\ud800\"]", "1:3", "half a character"},
        {"[\"\\ud83d\\ude00 \\udc00\"]", "1:16", "half a character"},
        {"[1] /* open", "1:5", "this comment does not end; close it with */"},
        {"[1, /* open", "1:5", "this comment does not end"},
        {"[1] / 2", "1:5", "expected the end of the file; found '/'"},
        {"[1, /]", "1:5", "expected a value; found '/'"},
        {std::string("[1,\n\0 2]", 9), "2:1", "byte 0x00 in what should be a text file"},
        {"[\"\x01\"]", "1:3", "byte 0x01 in what should be a text file"},
        {"\xff\xfe[", "1:1", "byte 0xff is no UTF-8 here; save the file as UTF-8"},
        {"[\"ä\xe4\"]", "1:5", "byte 0xe4 is no UTF-8 here"},
        {"// \xc3(", "1:4", "byte 0xc3 is no UTF-8"},
        {"// \xc0\xaf", "1:4", "byte 0xc0 is no UTF-8"},
        {"// \xed\xa0\x80", "1:4", "byte 0xed is no UTF-8"},
        {"// \xf4\x90\x80\x80", "1:4", "byte 0xf4 is no UTF-8"},
        {"{\"a\": 1,\n \"b\": 2, \"a\": 3}", "2:10",
         "the key 'a' is there a second time; the first is on line 1. Keep one of them"},
        {"{\"\\u0061\": 1, \"a\": 3}", "1:15", "the key 'a' is there a second time"},
        {"\n" + deep, "2:101", "arrays and objects are nested deeper than 100; nest them less"},
    };
    for (const Case& c : cases) {
        INFO(c.text);
        try {
            const JsonDocument document("a.json", c.text);
            FAIL_CHECK("was accepted");
        } catch (const SceneError& error) {
            CHECK_THAT(error.what(),
                       Catch::StartsWith("a.json:" + c.place + ": ") && Catch::Contains(c.says));
            CHECK_THAT(error.what(), !Catch::Contains("json.exception"));
        }
    }
}

TEST_CASE("Nesting of 100 is allowed", "[json]") {
    const std::string text = std::string(100, '[') + std::string(100, ']');
    CHECK(JsonDocument("a.json", text).root().count == 1);
}

}  // namespace sahl::tests
