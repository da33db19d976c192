// What a batch says while it works: a bar or lines on standard error, events on standard output, a status
// file.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/batch_outcome.h"
#include "cli/batch_setup.h"
#include "cli/values.h"

namespace sahl::cli {

class BatchReport {
public:
    BatchReport(const BatchSetup& setup, const CommonOptions& common,
                std::optional<std::filesystem::path> status_file);

    /// The first event, and how much there is to do. Throws Error(output) if events cannot be written.
    void begin(const std::vector<JobOutcome>& outcomes);
    void started(std::size_t job, const JobOutcome& outcome);
    void resumed(std::size_t job, std::uint64_t done, std::uint64_t total);
    /// Camera samples of the job that was started last.
    void progress(std::uint64_t done, std::uint64_t total);
    void rendered(std::size_t job, const JobOutcome& outcome);
    void finished_elsewhere(std::size_t job);
    void stopped(std::size_t job, bool has_checkpoint);
    void retried(std::size_t job, const std::string& message);
    void failed(std::size_t job, const JobOutcome& outcome);
    /// Lines that the worker wrote.
    void worker_said(const std::string& text);
    /// Called now and then.
    void tick();
    /// The last event and line.
    void end(const std::vector<JobOutcome>& outcomes, const BatchEnd& end);
    /// Why events were lost, if they were: that ends no batch.
    const std::optional<Error>& lost_events() const { return lost_events_; }

private:
    using Clock = std::chrono::steady_clock;

    std::string name_of(std::size_t job) const;
    void say(const std::string& line);
    void draw();
    void clear();
    /// In `columns`, if the file's name can be shortened to that.
    std::string status_line(std::size_t columns) const;
    double rays_per_second() const;
    /// Seconds that the rest takes, if it goes on as so far.
    std::optional<double> seconds_left() const;
    /// Of the samples of the image in work, `done`.
    double share_of_current(std::uint64_t done) const;
    /// What this run has done of it, where another had begun.
    std::uint64_t current_done_here() const { return current_done_ - current_begun_with_; }
    void emit(const nlohmann::ordered_json& event);
    void write_status(const char* state);

    const BatchSetup& setup_;
    bool is_quiet_;
    bool has_events_;
    std::optional<Error> lost_events_{};
    bool has_bar_;
    std::optional<std::filesystem::path> status_file_;
    Clock::time_point began_ = Clock::now();
    std::optional<Clock::time_point> drawn_{};
    std::optional<Clock::time_point> status_written_{};
    std::size_t bar_width_ = 0;
    std::size_t finished_before_ = 0;
    std::size_t finished_ = 0;  ///< all in all
    std::size_t rendered_ = 0;
    std::size_t failed_ = 0;
    std::optional<std::size_t> current_{};
    Clock::time_point current_began_{};
    std::uint64_t current_begun_with_ = 0;  ///< samples of a checkpoint
    std::uint64_t current_done_ = 0;
    std::uint64_t current_total_ = 0;
    double seconds_ = 0;  ///< of rendering what is rendered
    std::uint64_t rays_ = 0;
    std::uint64_t non_finite_ = 0;
};

}  // namespace sahl::cli
