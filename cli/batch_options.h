// What `sahl batch` is asked to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/values.h"
#include "engine/batch/batch_job.h"

namespace sahl::cli {

struct BatchOptions {
    std::vector<std::string> files;  ///< manifests and scenes
    std::vector<std::string> outputs;
    std::vector<std::string> cameras;
    std::vector<int> frames;
    ImageSettings settings;  ///< but for what the next three say
    std::vector<Aov> aovs;
    OutputSettings encoding;
    BuildQuality build_quality = BuildQuality::high;
    std::optional<Traversal> traversal;
    LoadOptions loading;
    std::optional<std::uint64_t> max_memory;  ///< bytes
    double hang_seconds = 600;
    double checkpoint_seconds = 60;
    bool dry_run = false;
    bool force = false;
    bool check = false;
    std::optional<std::string> status_file;
    std::optional<std::string> html_file;
};

/// What the command line says of the images.
ImageSettings image_settings(const BatchOptions& options);

/// `options` has to outlive `command`.
void add_batch_options(CLI::App& command, BatchOptions& options);

}  // namespace sahl::cli
