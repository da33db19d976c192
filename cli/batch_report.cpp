#include "cli/batch_report.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/standard_output.h"
#include "engine/core/atomic_file.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr auto between_bars = std::chrono::milliseconds(100);
constexpr auto between_lines = std::chrono::seconds(10);
constexpr auto between_status_files = std::chrono::seconds(1);

std::string bar(double share, std::size_t cells) {
    const auto filled = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(cells));
    return "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "]";
}

/// Of the terminal, less one: a line that fills it may wrap.
std::size_t bar_columns() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known ? size.ws_col - 1U : 79;
}

/// The end of a name, where it differs from others.
std::string shortened(const std::string& name, std::size_t columns) {
    if (name.size() <= columns) return name;
    std::size_t start = name.size() - (columns > 3 ? columns - 3 : 0);
    while (start < name.size() && (static_cast<unsigned char>(name[start]) & 0xc0U) == 0x80U) ++start;
    return "..." + name.substr(start);
}

}  // namespace

BatchReport::BatchReport(const BatchSetup& setup, const CommonOptions& common,
                         std::optional<std::filesystem::path> status_file)
    : setup_(setup),
      is_quiet_(common.quiet),
      has_events_(common.json),
      has_bar_(!common.quiet && isatty(STDERR_FILENO) != 0),
      status_file_(std::move(status_file)) {}

std::string BatchReport::name_of(std::size_t job) const {
    return fmt::format("{}", fmt::join(paths_of(setup_.jobs[job]), ", "));
}

void BatchReport::emit(const Json& event) {
    if (!has_events_ || lost_events_) return;
    try {
        print_event(event);
    } catch (const Error& error) {
        lost_events_ = error;
    }
}

void BatchReport::say(const std::string& line) {
    if (is_quiet_) return;
    clear();
    print_message(line + "\n");
    draw();
}

double BatchReport::rays_per_second() const {
    return seconds_ > 0 ? static_cast<double>(rays_) / seconds_ : 0;
}

double BatchReport::share_of_current(std::uint64_t done) const {
    if (!current_ || current_total_ == 0) return 0;
    return static_cast<double>(done) / static_cast<double>(current_total_);
}

std::optional<double> BatchReport::seconds_left() const {
    const double done = static_cast<double>(rendered_) + share_of_current(current_done_here());
    if (done <= 0) return std::nullopt;
    const double elapsed = std::chrono::duration<double>(Clock::now() - began_).count();
    const double all = static_cast<double>(setup_.jobs.size() - failed_);
    const double left = all - static_cast<double>(finished_) - share_of_current(current_done_);
    return elapsed / done * std::max(left, 0.0);
}

std::string BatchReport::status_line(std::size_t columns) const {
    const std::size_t all = setup_.jobs.size();
    const double share = share_of_current(current_done_);
    const double whole = (static_cast<double>(finished_) + share) / static_cast<double>(all);
    std::string line = fmt::format("{} {}/{}", bar(whole, 16), finished_, all);
    if (failed_ > 0) line += fmt::format(", {} failed", failed_);
    std::string end;
    if (current_) end += fmt::format(" {} {:3.0f} %", bar(share, 10), std::floor(100 * share));
    const double current_seconds = std::chrono::duration<double>(Clock::now() - current_began_).count();
    if (seconds_ > 0) {
        end += fmt::format("  {}rays/s", with_prefix(rays_per_second()));
    } else if (current_ && current_done_here() > 0) {
        // How many rays that makes is known at the end of an image.
        const double rate = static_cast<double>(current_done_here()) / current_seconds;
        end += fmt::format("  {}samples/s", with_prefix(rate));
    }
    if (const auto left = seconds_left()) end += "  ETA " + clock_time(*left);
    if (current_) {
        const std::size_t taken = line.size() + 2 + end.size();
        line += "  " + shortened(setup_.jobs[*current_].outputs.front().string(),
                                 columns > taken ? columns - taken : 0);
    }
    return line + end;
}

void BatchReport::draw() {
    if (!has_bar_) return;
    drawn_ = Clock::now();
    std::string line = status_line(bar_columns());
    const std::size_t width = line.size();
    if (width < bar_width_) line.append(bar_width_ - width, ' ');
    print_message("\r" + line);
    bar_width_ = width;
}

void BatchReport::clear() {
    if (bar_width_ == 0) return;
    print_message("\r" + std::string(bar_width_, ' ') + "\r");
    bar_width_ = 0;
}

void BatchReport::begin(const std::vector<JobOutcome>& outcomes) {
    finished_before_ = static_cast<std::size_t>(std::count_if(
        outcomes.begin(), outcomes.end(), [](const JobOutcome& o) { return o.state == JobState::finished; }));
    finished_ = finished_before_;
    emit({{"event", "start"},
          {"version", SAHL_VERSION},
          {"jobs", outcomes.size()},
          {"finished", finished_before_},
          {"to_render", outcomes.size() - finished_before_}});
    if (lost_events_) throw Error(*lost_events_);
    say(fmt::format("{} image{}, {} finished", outcomes.size(), outcomes.size() == 1 ? "" : "s",
                    finished_before_));
    write_status("running");
}

void BatchReport::started(std::size_t job, const JobOutcome& outcome) {
    current_ = job;
    current_began_ = Clock::now();
    current_begun_with_ = 0;
    current_done_ = 0;
    current_total_ = 0;
    emit({{"event", "render"},
          {"job", job},
          {"paths", paths_of(setup_.jobs[job])},
          {"reason", outcome.reason}});
}

void BatchReport::resumed(std::size_t job, std::uint64_t done, std::uint64_t total) {
    current_begun_with_ = done;
    progress(done, total);
    emit({{"event", "resume"}, {"job", job}, {"done", done}, {"total", total}});
    say(fmt::format("{}: goes on from its checkpoint, {:.0f} % of the samples", name_of(job),
                    100.0 * static_cast<double>(done) / static_cast<double>(total)));
}

void BatchReport::progress(std::uint64_t done, std::uint64_t total) {
    current_done_ = done;
    current_total_ = total;
}

void BatchReport::rendered(std::size_t job, const JobOutcome& outcome) {
    ++finished_;
    ++rendered_;
    seconds_ += outcome.seconds;
    rays_ += outcome.rays + outcome.shadow_rays;
    non_finite_ += outcome.non_finite;
    if (current_ == job) current_.reset();
    emit({{"event", "image"},
          {"job", job},
          {"paths", paths_of(setup_.jobs[job])},
          {"seconds", outcome.seconds},
          {"loaded", outcome.loaded},
          {"built", outcome.built},
          {"rays", outcome.rays},
          {"shadow_rays", outcome.shadow_rays},
          {"non_finite", outcome.non_finite},
          {"clamped", outcome.clamped}});
    std::string line = fmt::format("wrote {}  {:.2f} s", name_of(job), outcome.seconds);
    if (outcome.seconds > 0) {
        const double rate = static_cast<double>(outcome.rays + outcome.shadow_rays) / outcome.seconds;
        line += fmt::format(", {}rays/s", with_prefix(rate));
    }
    say(fmt::format("{}  ({})", line, outcome.reason));
    if (outcome.non_finite > 0)
        log_warning(fmt::format("{}: {} contributions were no finite numbers and count as black",
                                name_of(job), outcome.non_finite));
    if (outcome.clamped > 0)
        log_warning(fmt::format("{}: {} contributions were brighter than {} and were cut to that",
                                name_of(job), outcome.clamped, Film::max_contribution));
}

void BatchReport::finished_elsewhere(std::size_t job) {
    ++finished_;
    ++finished_before_;
    emit({{"event", "finished"}, {"job", job}, {"paths", paths_of(setup_.jobs[job])}});
}

void BatchReport::stopped(std::size_t job, bool has_checkpoint) {
    emit({{"event", "stopped"}, {"job", job}, {"checkpoint", has_checkpoint}});
    if (has_checkpoint) say(fmt::format("{}: kept as a checkpoint", name_of(job)));
}

void BatchReport::retried(std::size_t job, const std::string& message) {
    if (current_ == job) current_.reset();
    emit({{"event", "retry"}, {"job", job}, {"paths", paths_of(setup_.jobs[job])}, {"message", message}});
    clear();
    log_warning(fmt::format("{}: {}; it is tried once more", name_of(job), message));
}

void BatchReport::failed(std::size_t job, const JobOutcome& outcome) {
    ++failed_;
    if (current_ == job) current_.reset();
    Json event{{"event", "failed"},
               {"job", job},
               {"paths", paths_of(setup_.jobs[job])},
               {"code", static_cast<int>(outcome.code)},
               {"message", outcome.message}};
    if (!outcome.log_file.empty()) event["log"] = outcome.log_file.string();
    emit(event);
    clear();
    const std::string where =
        outcome.log_file.empty() ? "" : fmt::format("; its log is {}", outcome.log_file.string());
    log_error(fmt::format("{}: {}{}", name_of(job), outcome.message, where));
}

void BatchReport::worker_said(const std::string& text) {
    if (text.empty() || is_quiet_) return;
    clear();
    print_message(text);
}

void BatchReport::tick() {
    const auto now = Clock::now();
    if (has_bar_ && (!drawn_ || now - *drawn_ >= between_bars)) draw();
    if (!has_bar_ && !is_quiet_ && now - drawn_.value_or(began_) >= between_lines) {
        drawn_ = now;
        print_message(status_line(std::numeric_limits<std::size_t>::max()) + "\n");
    }
    if (!status_written_ || now - *status_written_ >= between_status_files) write_status("running");
}

void BatchReport::end(const std::vector<JobOutcome>& outcomes, const BatchEnd& end) {
    clear();
    has_bar_ = false;
    current_.reset();
    const std::size_t left = outcomes.size() - finished_ - failed_;
    const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
    emit({{"event", "summary"},
          {"jobs", outcomes.size()},
          {"finished_before", finished_before_},
          {"rendered", rendered_},
          {"failed", failed_},
          {"left", left},
          {"seconds", seconds},
          {"render_seconds", seconds_},
          {"rays", rays_},
          {"non_finite", non_finite_}});
    std::string line = fmt::format("{} of {} images are finished: {} before, {} now in {}", finished_,
                                   outcomes.size(), finished_before_, rendered_, clock_time(seconds));
    if (failed_ > 0) line += fmt::format("; {} failed", failed_);
    if (left > 0) line += fmt::format("; {} are left, the same command goes on with them", left);
    say(line);
    write_status(end.interrupted ? "interrupted" : end.code == ExitCode::ok ? "done" : "failed");
}

void BatchReport::write_status(const char* state) {
    if (!status_file_) return;
    status_written_ = Clock::now();
    Json status{{"state", state},
                {"pid", ::getpid()},
                {"updated", std::time(nullptr)},
                {"jobs", setup_.jobs.size()},
                {"finished", finished_},
                {"rendered", rendered_},
                {"failed", failed_},
                {"elapsed_seconds", std::chrono::duration<double>(Clock::now() - began_).count()},
                {"rays_per_second", rays_per_second()}};
    if (const auto left = seconds_left()) status["seconds_left"] = *left;
    if (current_) {
        status["current"] = {{"job", *current_},
                             {"paths", paths_of(setup_.jobs[*current_])},
                             {"done", current_done_},
                             {"total", current_total_}};
    }
    const std::string text = status.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    try {
        write_file(*status_file_, std::as_bytes(std::span(text)));
    } catch (const Error& error) {
        // The images matter more.
        log_warning(error.what());
        status_file_.reset();
    }
}

}  // namespace sahl::cli
