// What the progress display writes and when, by a clock that the tests turn.
#include "engine/core/progress.h"

#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>

namespace sahl {
namespace {

struct Display {
    double now = 100;
    std::ostringstream out;
    Progress progress;

    explicit Display(ProgressStyle style)
        : progress(out, style, "depth 4", "samples", [this] { return now; }) {}

    /// What an update after `seconds` more writes.
    std::string after(double seconds, std::uint64_t done, std::uint64_t total) {
        now += seconds;
        out.str("");
        progress.update(done, total);
        return out.str();
    }
};

TEST_CASE("progress: a bar shows share, rate and time left", "[progress]") {
    Display display(ProgressStyle::bar);
    // 1 million of 4 in one second: a quarter of the 24 cells, 1 M/s, 3 s to go.
    CHECK(display.after(1, 1'000'000, 4'000'000) ==
          "\rdepth 4  [######..................]  25 %  1.0 Msamples/s  ETA 0:03");
}

TEST_CASE("progress: a bar is redrawn ten times a second at most", "[progress]") {
    Display display(ProgressStyle::bar);
    CHECK(display.after(0, 0, 10) != "");
    CHECK(display.after(0.0625, 1, 10) == "");
    CHECK(display.after(0.0625, 2, 10) != "");
    int drawn = 0;
    for (int i = 0; i < 1024; ++i) drawn += display.after(1.0 / 1024, 3, 10).empty() ? 0 : 1;
    CHECK(drawn <= 10);
    CHECK(drawn >= 9);
}

TEST_CASE("progress: a shorter bar covers the longer one before it", "[progress]") {
    Display display(ProgressStyle::bar);
    const std::string with_time_left = display.after(1, 1, 1000);
    const std::string finished = display.after(1, 1000, 1000);
    CHECK(finished.size() == with_time_left.size());
    CHECK(finished.back() == ' ');
}

TEST_CASE("progress: the bar is gone at the end and no escape codes were used", "[progress]") {
    std::ostringstream out;
    {
        double now = 0;
        Progress progress(out, ProgressStyle::bar, "depth 4", "samples", [&now] { return now; });
        now = 1;
        progress.update(1, 2);
    }
    const std::string text = out.str();
    CHECK(text.find('\x1b') == std::string::npos);
    CHECK(text.find('\n') == std::string::npos);
    const std::size_t last = text.rfind('\r');
    REQUIRE(last == text.size() - 1);
    const std::size_t blanks = text.rfind('\r', last - 1);
    const std::size_t drawn = blanks - 1;  // without the first '\r'
    CHECK(text.substr(blanks + 1, last - blanks - 1) == std::string(drawn, ' '));
}

TEST_CASE("progress: plain lines come every ten seconds at most, short work has none", "[progress]") {
    Display display(ProgressStyle::lines);
    CHECK(display.after(0, 0, 100) == "");
    CHECK(display.after(9.5, 10, 100) == "");
    CHECK(display.after(0.5, 20, 100) == "depth 4   20 %  2 samples/s  ETA 0:40\n");
    CHECK(display.after(9.5, 30, 100) == "");
    CHECK(display.after(0.5, 100, 100) == "depth 4  100 %  5 samples/s\n");
}

TEST_CASE("progress: the style none writes nothing", "[progress]") {
    Display display(ProgressStyle::none);
    CHECK(display.after(100, 1, 2) == "");
}

TEST_CASE("progress: 100 % only when all is done, and without work", "[progress]") {
    Display display(ProgressStyle::bar);
    CHECK(display.after(1, 9999, 10000).find(" 99 %") != std::string::npos);
    CHECK(display.after(1, 0, 0).find("100 %") != std::string::npos);
}

TEST_CASE("progress: numbers with decimal prefixes", "[progress]") {
    CHECK(with_prefix(0) == "0 ");
    CHECK(with_prefix(999) == "999 ");
    CHECK(with_prefix(999.6) == "1.0 k");
    CHECK(with_prefix(12'345) == "12.3 k");
    CHECK(with_prefix(99'960) == "100 k");
    CHECK(with_prefix(12.3e6) == "12.3 M");
    CHECK(with_prefix(4.56e9) == "4.6 G");
}

TEST_CASE("progress: clock times", "[progress]") {
    CHECK(clock_time(0) == "0:00");
    CHECK(clock_time(6.2) == "0:07");
    CHECK(clock_time(754) == "12:34");
    CHECK(clock_time(3723) == "1:02:03");
    CHECK(clock_time(1e300) == "99:59:59");
}

}  // namespace
}  // namespace sahl
