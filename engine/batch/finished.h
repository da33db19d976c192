// Which images of a batch are finished.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/batch/batch_job.h"
#include "engine/batch/folder_state.h"
#include "engine/batch/job_record.h"
#include "engine/batch/scene_content.h"

namespace sahl {

/// One file of a job.
struct BatchOutput {
    std::filesystem::path path;
    OutputSettings encoding{};
    bool has_aovs = false;
    std::string record{};  ///< see make_record
};

/// The files of `job` with their records.
std::vector<BatchOutput> outputs_of(const BatchJob& job, const SceneContent& content,
                                    const EngineIdentity& engine);

/// Why `output` is not finished: its file is not there, not whole, or of something else ("spp changed from 1
/// to 4"). Empty if it is. `folders` keeps what was read of their records.
std::string reason_to_render(const BatchOutput& output,
                             std::map<std::filesystem::path, FolderRecords>& folders);

}  // namespace sahl
