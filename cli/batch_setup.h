// What a batch is to do, and how.
#pragma once

#include <cstdint>
#include <optional>
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

/// Where the film of a job is kept while it is not finished.
inline std::filesystem::path checkpoint_of(const BatchJob& job) {
    const std::filesystem::path& first = job.outputs.front();
    return first.parent_path() / ("." + first.filename().string() + ".checkpoint");
}

}  // namespace sahl::cli
