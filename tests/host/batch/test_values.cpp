// Lists, ranges, key frames and names of files.
#include <catch2/catch.hpp>

#include "engine/batch/key_frames.h"
#include "engine/batch/number_ranges.h"
#include "engine/batch/output_pattern.h"

namespace sahl::tests {
namespace {

using Numbers = std::vector<double>;

KeyFrames keys(Interpolation interpolation, Numbers frames, const Numbers& values) {
    KeyFrames result{false, interpolation, std::move(frames), {}};
    for (const double value : values) result.values.emplace_back(value, 0, 0);
    return result;
}

}  // namespace

TEST_CASE("batch values: numbers and ranges, up and down, in steps", "[batch]") {
    CHECK(parse_ranges("7") == Numbers{7});
    CHECK(parse_ranges("1-4") == Numbers{1, 2, 3, 4});
    CHECK(parse_ranges("1-8x3,150") == Numbers{1, 4, 7, 150});
    CHECK(parse_ranges("3-1") == Numbers{3, 2, 1});
    CHECK(parse_ranges("-2--1,-1-1") == Numbers{-2, -1, -1, 0, 1});
    const auto tenths = parse_ranges("0-1x0.1");  // 10 * 0.1 is no 1 in binary
    REQUIRE(tenths);
    CHECK(tenths->size() == 11);
    CHECK(tenths->back() == Approx(1));
    for (const char* text : {"", "1,", ",1", "1-", "1-2x", "1-2x0", "1-2x-1", "a", "1 2", "1-2y3", "1e3",
                             "nan", "0-999999999", "1-1000000,1"}) {
        INFO(text);
        CHECK_FALSE(parse_ranges(text));
    }
}

TEST_CASE("batch values: key frames are met exactly, linear between and constant outside", "[batch]") {
    const KeyFrames line = keys(Interpolation::linear, {1, 3, 11}, {10, 20, 0.1});
    CHECK(line.at(-5).x == 10);
    CHECK(line.at(1).x == 10);
    CHECK(line.at(2).x == 15);
    CHECK(line.at(3).x == 20);
    CHECK(line.at(11).x == 0.1);
    CHECK(line.at(99).x == 0.1);
}

TEST_CASE("batch values: smooth key frames have no corner and go beyond no key", "[batch]") {
    const Numbers frames{0, 10, 20, 30, 50};
    const Numbers values{0, 1, 1, 9, 0};
    const KeyFrames curve = keys(Interpolation::smooth, frames, values);
    for (std::size_t i = 0; i < frames.size(); ++i) CHECK(curve.at(frames[i]).x == values[i]);
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        const auto [low, high] = std::minmax(values[i], values[i + 1]);
        for (double frame = frames[i]; frame < frames[i + 1]; frame += 0.25) {
            CHECK(curve.at(frame).x >= low - 1e-12);
            CHECK(curve.at(frame).x <= high + 1e-12);
        }
    }
    constexpr double h = 1e-6;
    for (const double key : {10.0, 20.0, 30.0}) {
        const double before = (curve.at(key).x - curve.at(key - h).x) / h;
        const double behind = (curve.at(key + h).x - curve.at(key).x) / h;
        CHECK(before == Approx(behind).margin(1e-4));
    }
    // A straight line stays one.
    const KeyFrames straight = keys(Interpolation::smooth, {0, 1, 4}, {0, 2, 8});
    for (const double frame : {0.3, 1.7, 3.9}) CHECK(straight.at(frame).x == Approx(2 * frame));
}

TEST_CASE("batch values: placeholders are filled in, with zeros in front of whole numbers", "[batch]") {
    const PlaceholderValues values{
        {"scene", "room"}, {"frame", "7"}, {"sun", "0.5"}, {"low", "-3"}, {"path", "a/b"}};
    const auto fill = [&](const char* pattern) {
        const FilledPattern filled = fill_pattern(pattern, values);
        CHECK(filled.problem == "");
        return filled.text;
    };
    CHECK(fill("out/{scene}/{frame:04}_{sun}.exr") == "out/room/0007_0.5.exr");
    CHECK(fill("{low:03}{frame}{frame}.png") == "-00377.png");
    CHECK(fill("plain.png") == "plain.png");
    CHECK(fill("open{.png") == "open{.png");
    const auto problem = [&](const char* pattern) { return fill_pattern(pattern, values).problem; };
    CHECK(problem("{fram}.png").find("did you mean 'frame'?") != std::string::npos);
    CHECK(problem("{zzzzzz}").find("there is {scene}, {frame}") != std::string::npos);
    CHECK(problem("{frame:4}").find("{frame:04}") != std::string::npos);
    CHECK(problem("{sun:04}").find("whole numbers") != std::string::npos);
    CHECK(problem("{path}.png").find("a / in it") != std::string::npos);
}

}  // namespace sahl::tests
