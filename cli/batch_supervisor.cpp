#include "cli/batch_supervisor.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <memory>
#include <stop_token>
#include <utility>

#include <fmt/format.h>

#include "cli/batch_order.h"
#include "cli/batch_process.h"
#include "cli/interruption.h"
#include "engine/core/atomic_file.h"

namespace sahl::cli {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int most_attempts = 2;
/// A full disk or a missing driver would fail the whole night's jobs one by one.
constexpr int most_failures_in_a_row = 3;
constexpr int milliseconds_of_waiting = 500;
constexpr std::chrono::seconds seconds_of_pause{5};  ///< longer than waiting takes on a busy machine
constexpr double seconds_to_stop = 30;  ///< for a worker that is told to; a checkpoint may be gigabytes

/// Becomes readable when the first SIGINT or SIGTERM comes.
class StopEvent {
public:
    StopEvent()
        : file_(::eventfd(0, EFD_CLOEXEC)),
          callback_(interruption(), [this] { ::eventfd_write(file_, 1); }) {}
    ~StopEvent() { ::close(file_); }
    StopEvent(const StopEvent&) = delete;
    StopEvent& operator=(const StopEvent&) = delete;
    int file() const { return file_; }

private:
    int file_;
    std::stop_callback<std::function<void()>> callback_;
};

bool is_left(const JobOutcome& outcome) {
    return outcome.state == JobState::waiting || outcome.state == JobState::rendering ||
           outcome.state == JobState::writing;
}

fs::path log_file_of(const BatchJob& job) { return job.outputs.front().string() + ".log"; }

class Supervisor {
public:
    Supervisor(BatchSetup& setup, std::vector<JobOutcome>& outcomes, double hang_seconds, BatchReport& report)
        : setup_(setup), outcomes_(outcomes), hang_(hang_seconds), report_(report) {
        for (std::size_t i = 0; i < outcomes.size(); ++i)
            if (outcomes[i].state == JobState::waiting) waiting_.push_back(i);
    }

    BatchEnd run() {
        while (!is_done()) {
            give_work();
            listen();
        }
        worker_.reset();
        const bool failed = std::any_of(outcomes_.begin(), outcomes_.end(),
                                        [](const JobOutcome& o) { return o.state == JobState::failed; });
        if (end_.code == ExitCode::ok && failed) end_.code = ExitCode::jobs_failed;
        end_.interrupted = stopping_ && std::any_of(outcomes_.begin(), outcomes_.end(), is_left);
        return end_;
    }

private:
    bool is_done() const {
        if (stopping_) return !worker_;
        const bool idle = !rendering_ && writing_.empty();
        return idle && (end_.code != ExitCode::ok || (waiting_.empty() && taken_.empty()));
    }

    /// A job that has failed once goes alone: so it is known which one fails.
    void give_work() {
        if (stopping_ || rendering_ || end_.code != ExitCode::ok) return;
        const bool wait = waiting_.empty();
        std::deque<std::size_t>& from = wait ? taken_ : waiting_;
        if (from.empty()) return;
        const std::size_t job = from.front();
        const bool alone = outcomes_[job].attempts > 0;
        if (!writing_.empty() && (alone || is_alone_ || wait)) return;
        if (!worker_) {
            worker_ = std::make_unique<WorkerProcess>(setup_.worker);
            told_ = nullptr;
        }
        is_alone_ = alone;
        from.pop_front();
        rendering_ = job;
        is_started_ = false;
        heard_ = Clock::now();
        const SceneContent& content = setup_.content_of(setup_.jobs[job]);
        const bool is_new = std::exchange(told_, &content) != &content;
        // If that fails, its end is seen.
        worker_->socket().send(message_of(job, wait, setup_.jobs[job], is_new ? &content : nullptr));
    }

    void listen() {
        if (!worker_) return;
        std::array<pollfd, 2> files{pollfd{worker_->socket().file(), POLLIN, 0},
                                    pollfd{stopping_ ? -1 : stop_event_.file(), POLLIN, 0}};
        const Clock::time_point asked = Clock::now();
        ::poll(files.data(), files.size(), milliseconds_of_waiting);
        // Stopped (Ctrl-Z), and the worker with it: that is no silence.
        if (Clock::now() - asked > seconds_of_pause) heard_ = Clock::now();
        if (files[1].revents != 0) stop();
        if (files[0].revents != 0) {
            if (!worker_->socket().receive()) return worker_ended();
            heard_ = Clock::now();
            while (worker_) {  // it may be replaced
                const std::optional<nlohmann::json> message = worker_->socket().next();
                if (!message) break;
                take(*message);
            }
            if (!worker_) return;
            pass_on_warnings();
        }
        report_.tick();
        const double silent = std::chrono::duration<double>(Clock::now() - heard_).count();
        // Who waits for another process's claim is silent for good reason.
        const bool works = is_started_ || !writing_.empty();
        if ((works && silent > hang_) || (stopping_ && silent > seconds_to_stop)) {
            hung_ = works && !stopping_;
            worker_->kill();
        }
    }

    void stop() {
        stopping_ = true;
        heard_ = Clock::now();
        // One that waits for a claim does not hear it.
        if (rendering_ && !is_started_ && writing_.empty()) worker_->kill();
        worker_->socket().send({{"stop", true}});
    }

    /// `failed` is only known to be of rendering or of writing by where the job is.
    void release(std::size_t job) {
        if (rendering_ == job) {
            rendering_.reset();
            is_started_ = false;
        }
        std::erase(writing_, job);
    }

    void take(const nlohmann::json& message) {
        const auto is = [&](const char* event) { return message.contains(event); };
        const auto job_of = [&](const char* event) { return message.at(event).get<std::size_t>(); };
        if (is("progress")) {
            report_.progress(message.at("done"), message.at("total"));
        } else if (is("started")) {
            is_started_ = true;
            outcomes_[*rendering_].state = JobState::rendering;
            report_.started(*rendering_, outcomes_[*rendering_]);
        } else if (is("resumed")) {
            report_.resumed(*rendering_, message.at("done"), message.at("total"));
        } else if (is("taken")) {
            taken_.push_back(job_of("taken"));
            release(taken_.back());
        } else if (is("finished")) {
            const std::size_t job = job_of("finished");
            release(job);
            outcomes_[job].state = JobState::finished;
            report_.finished_elsewhere(job);
        } else if (is("rendered")) {
            rendered(job_of("rendered"), message);
        } else if (is("written")) {
            written(job_of("written"));
        } else if (is("failed")) {
            failed(job_of("failed"), static_cast<ExitCode>(message.at("code").get<int>()),
                   message.at("message"));
        } else if (is("stopped")) {
            report_.stopped(job_of("stopped"), message.at("checkpoint"));
        }
    }

    void rendered(std::size_t job, const nlohmann::json& message) {
        JobOutcome& outcome = outcomes_[job];
        outcome.state = JobState::writing;
        outcome.seconds = message.at("seconds");
        outcome.loaded = message.at("loaded");
        outcome.built = message.at("built");
        outcome.rays = message.at("rays");
        outcome.shadow_rays = message.at("shadow_rays");
        outcome.non_finite = message.at("non_finite");
        outcome.clamped = message.at("clamped");
        release(job);
        writing_.push_back(job);
    }

    void written(std::size_t job) {
        release(job);
        in_a_row_ = 0;
        outcomes_[job].state = JobState::rendered;
        std::error_code ignored;
        fs::remove(log_file_of(setup_.jobs[job]), ignored);  // of an earlier failure
        report_.rendered(job, outcomes_[job]);
    }

    void failed(std::size_t job, ExitCode code, const std::string& message) {
        release(job);
        const bool may_pass =
            code == ExitCode::memory || code == ExitCode::device || code == ExitCode::internal;
        if (may_pass && !stopping_) {
            const std::string log = worker_->take_log();
            requeue_others();
            worker_.reset();  // what is left of it may be why
            return try_again(job, code, message, log);
        }
        give_up(job, code, message, worker_->take_log());
    }

    /// What else the worker had in hand goes with it, and is not to blame.
    void requeue_others() {
        std::vector<std::size_t> others = std::exchange(writing_, {});
        if (rendering_) others.push_back(*rendering_);
        rendering_.reset();
        is_started_ = false;
        for (const std::size_t job : others) {
            outcomes_[job].state = JobState::waiting;
            waiting_.push_front(job);
        }
    }

    void try_again(std::size_t job, ExitCode code, const std::string& message, const std::string& log) {
        if (++outcomes_[job].attempts >= most_attempts) return give_up(job, code, message, log);
        outcomes_[job].state = JobState::waiting;
        waiting_.push_front(job);
        report_.retried(job, message);
    }

    void give_up(std::size_t job, ExitCode code, const std::string& message, const std::string& log) {
        JobOutcome& outcome = outcomes_[job];
        outcome.state = JobState::failed;
        outcome.code = code;
        outcome.message = message;
        if (!log.empty()) {
            try {
                const std::string text = log + message + "\n";
                write_file(log_file_of(setup_.jobs[job]), std::as_bytes(std::span(text)));
                outcome.log_file = log_file_of(setup_.jobs[job]);
            } catch (const Error&) {
                // The message has to do.
            }
        }
        report_.failed(job, outcome);
        const bool is_common = code == ExitCode::output || code == ExitCode::device;
        in_a_row_ = is_common ? in_a_row_ + 1 : 0;
        if (in_a_row_ == most_failures_in_a_row) {
            end_.code = code;
            end_.message = fmt::format(
                "{} jobs one after the other failed in the same way, so the rest was not tried", in_a_row_);
        }
    }

    void worker_ended() {
        const std::string log = worker_->take_log();
        const std::string end = worker_->wait();
        worker_.reset();
        if (stopping_) return;
        const std::string message =
            hung_ ? fmt::format("the worker showed no progress for {} s and was ended", hang_)
                  : "the worker " + end;
        hung_ = false;
        // One that failed in a worker by itself has no one beside it to blame.
        std::vector<std::size_t> blamed = writing_;
        if (rendering_) blamed.push_back(*rendering_);
        rendering_.reset();
        is_started_ = false;
        writing_.clear();
        for (const std::size_t job : blamed) try_again(job, ExitCode::internal, message, log + "\n");
    }

    void pass_on_warnings() {
        if (rendering_ && is_started_) return;  // they may become the log of a failure
        report_.worker_said(worker_->take_log());
    }

    BatchSetup& setup_;
    std::vector<JobOutcome>& outcomes_;
    double hang_;
    BatchReport& report_;
    StopEvent stop_event_{};
    std::unique_ptr<WorkerProcess> worker_{};
    const SceneContent* told_ = nullptr;  ///< the content that the worker was told of last
    std::deque<std::size_t> waiting_{};
    std::deque<std::size_t> taken_{};  ///< by other processes
    std::optional<std::size_t> rendering_{};
    std::vector<std::size_t> writing_{};
    bool is_started_ = false;  ///< the rendering job has its claim
    bool is_alone_ = false;    ///< the worker's last job had failed before
    bool hung_ = false;
    bool stopping_ = false;
    int in_a_row_ = 0;
    Clock::time_point heard_{};
    BatchEnd end_{};
};

}  // namespace

BatchEnd run_batch(BatchSetup& setup, std::vector<JobOutcome>& outcomes, double hang_seconds,
                   BatchReport& report) {
    return Supervisor(setup, outcomes, hang_seconds, report).run();
}

}  // namespace sahl::cli
