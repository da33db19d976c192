// What a batch is to do, and how.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/batch/batch_job.h"
#include "engine/batch/finished.h"
#include "engine/batch/job_record.h"
#include "engine/batch/scene_content.h"
#include "engine/core/log.h"
#include "engine/sahl.h"

namespace sahl::cli {

/// What a worker needs to know beside its jobs.
struct WorkerSettings {
    DeviceOptions device{};
    std::optional<std::uint64_t> max_memory{};
    double checkpoint_seconds = 60;  ///< 0: no checkpoints
    bool force = false;
    EngineIdentity engine{};
    LogLevel log_level = LogLevel::normal;
};

struct BatchSetup {
    std::vector<BatchJob> jobs{};
    SceneContents contents{};
    WorkerSettings worker{};

    const SceneContent& content_of(const BatchJob& job) { return contents.of(job.scene, job.parameters); }
};

/// The outputs, as texts.
inline std::vector<std::string> paths_of(const BatchJob& job) {
    std::vector<std::string> paths;
    for (const std::filesystem::path& output : job.outputs) paths.push_back(output.string());
    return paths;
}

/// Where the film of a job is kept while it is not finished.
inline std::filesystem::path checkpoint_of(const BatchJob& job) {
    const std::filesystem::path& first = job.outputs.front();
    return first.parent_path() / ("." + first.filename().string() + ".checkpoint");
}

}  // namespace sahl::cli
