#include "engine/core/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace sahl {

namespace {

constexpr double seconds_between_bars = 0.1;
constexpr double seconds_between_lines = 10;
constexpr std::size_t bar_cells = 24;
/// Before this much of a second, rates and the time left are noise.
constexpr double seconds_until_rate = 0.2;

double share(std::uint64_t done, std::uint64_t total) {
    if (total == 0) return 1;
    return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

}  // namespace

Progress::Progress(std::ostream& out, ProgressStyle style, std::string label, std::string unit, Clock clock)
    : out_(out),
      style_(style),
      label_(std::move(label)),
      unit_(std::move(unit)),
      clock_(std::move(clock)),
      started_(clock_()) {
    // The first plain line is due after a full interval: short work leaves no lines at all.
    if (style_ == ProgressStyle::lines) written_ = started_;
}

Progress::~Progress() { clear_bar(); }

double Progress::steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
    if (style_ == ProgressStyle::none) return;
    const double now = clock_();
    const double interval = style_ == ProgressStyle::bar ? seconds_between_bars : seconds_between_lines;
    if (written_ && now - *written_ < interval) return;
    written_ = now;
    const std::string status = text(done, total, now - started_);
    if (style_ == ProgressStyle::bar) {
        draw_bar(done, total, status);
    } else {
        out_ << label_ << "  " << status << '\n' << std::flush;
    }
}

std::string Progress::text(std::uint64_t done, std::uint64_t total, double seconds) const {
    // Rounded down: 100 % is shown only when all is done.
    std::string status = fmt::format("{:3.0f} %", std::floor(100 * share(done, total)));
    if (done == 0 || seconds < seconds_until_rate) return status;
    const double rate = static_cast<double>(done) / seconds;
    status += fmt::format("  {}{}/s", with_prefix(rate), unit_);
    if (done < total) status += "  ETA " + clock_time(static_cast<double>(total - done) / rate);
    return status;
}

void Progress::draw_bar(std::uint64_t done, std::uint64_t total, const std::string& status) {
    const auto filled = static_cast<std::size_t>(share(done, total) * static_cast<double>(bar_cells));
    std::string line = fmt::format("{}  [{}{}] {}", label_, std::string(filled, '#'),
                                   std::string(bar_cells - filled, '.'), status);
    const std::size_t width = line.size();
    if (width < bar_width_) line.append(bar_width_ - width, ' ');
    out_ << '\r' << line << std::flush;
    bar_width_ = width;
}

void Progress::clear_bar() {
    if (bar_width_ == 0) return;
    out_ << '\r' << std::string(bar_width_, ' ') << '\r' << std::flush;
    bar_width_ = 0;
}

std::string with_prefix(double value) {
    constexpr const char* prefixes[] = {"", "k", "M", "G", "T"};
    std::size_t prefix = 0;
    // 999.5 would be rounded up to four figures.
    while (value >= 999.5 && prefix + 1 < std::size(prefixes)) {
        value /= 1000;
        ++prefix;
    }
    const int decimals = value < 99.95 && prefix > 0 ? 1 : 0;
    return fmt::format("{:.{}f} {}", value, decimals, prefixes[prefix]);
}

std::string clock_time(double seconds) {
    constexpr double longest = 359999;  // 99:59:59
    const auto whole = static_cast<long>(std::clamp(std::ceil(seconds), 0.0, longest));
    const long hours = whole / 3600;
    const long minutes = whole / 60 % 60;
    if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
    return fmt::format("{}:{:02}", minutes, whole % 60);
}

}  // namespace sahl
