// How far a long piece of work is: one redrawn bar on a terminal, now and then a plain line elsewhere.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <string>

namespace sahl {

enum class ProgressStyle { none, lines, bar };

/// Shows the share done, the rate and the time left. The bar is redrawn at most ten times a second
/// and consists of plain characters (no escape codes); lines come at most every ten seconds.
class Progress {
public:
    /// Seconds from any fixed moment, never going back.
    using Clock = std::function<double()>;

    /// `label` goes in front, `unit` behind the rate ("samples": "12.3 Msamples/s").
    /// The work begins now.
    Progress(std::ostream& out, ProgressStyle style, std::string label, std::string unit,
             Clock clock = steady_seconds);
    /// Takes the bar off the screen.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `done` of `total` units are finished. Writes when it is time to.
    void update(std::uint64_t done, std::uint64_t total);

    static double steady_seconds();

private:
    std::string text(std::uint64_t done, std::uint64_t total, double seconds) const;
    void draw_bar(std::uint64_t done, std::uint64_t total, const std::string& text);
    void clear_bar();

    std::ostream& out_;
    ProgressStyle style_;
    std::string label_;
    std::string unit_;
    Clock clock_;
    double started_;
    std::optional<double> written_;  ///< when something was written last
    std::size_t bar_width_ = 0;      ///< characters on the screen
};

/// "12.3 M", "456 k", "789 ": three figures and a decimal prefix, for rates.
std::string with_prefix(double value);

/// "0:07", "12:34", "1:02:03": hours, minutes and seconds.
std::string clock_time(double seconds);

}  // namespace sahl
