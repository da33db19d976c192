// What supervisor and worker of a batch both know.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/batch/batch_job.h"
#include "engine/batch/finished.h"
#include "engine/batch/job_record.h"
#include "engine/batch/scene_content.h"
#include "engine/sahl.h"

namespace sahl::cli {

struct BatchSetup {
    std::vector<BatchJob> jobs;
    SceneContents contents{};
    EngineIdentity engine = engine_identity();
    DeviceOptions device{};
    std::optional<std::uint64_t> max_memory{};
    double checkpoint_seconds = 60;  ///< 0: no checkpoints
    bool force = false;

    const SceneContent& content_of(const BatchJob& job) { return contents.of(job.scene, job.parameters); }
};

/// Where the film of a job is kept while it is not finished.
inline std::filesystem::path checkpoint_of(const BatchJob& job) {
    const std::filesystem::path& first = job.outputs.front();
    return first.parent_path() / ("." + first.filename().string() + ".checkpoint");
}

}  // namespace sahl::cli
