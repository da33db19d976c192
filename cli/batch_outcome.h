// What becomes of the jobs of a batch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/sahl.h"

namespace sahl::cli {

enum class JobState {
    finished,  ///< before this run, or by another process
    waiting,
    rendering,
    writing,
    rendered,  ///< by this run
    failed
};

struct JobOutcome {
    JobState state = JobState::waiting;
    std::string reason{};  ///< why it is rendered
    double seconds = 0;    ///< of rendering
    bool loaded = false;   ///< its scene had to be read
    bool built = false;    ///< and its tree to be built
    std::uint64_t rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t non_finite = 0;
    std::uint64_t clamped = 0;
    int attempts = 0;  ///< that failed
    ExitCode code = ExitCode::ok;
    std::string message{};             ///< of a failure
    std::filesystem::path log_file{};  ///< of a failure that left one
};

/// How a batch ended.
struct BatchEnd {
    ExitCode code = ExitCode::ok;
    std::string message{};  ///< why it ended before its end; empty: it did not
    bool interrupted = false;
};

}  // namespace sahl::cli
