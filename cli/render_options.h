// What `sahl render` is asked to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/values.h"

namespace sahl::cli {

struct RenderOptions {
    std::string scene;
    LoadOptions loading;
    std::vector<std::string> outputs;
    std::optional<std::string> camera;
    std::optional<Resolution> size;
    std::optional<std::vector<int>> depths;
    std::optional<Crop> crop;
    int spp = 1;
    std::optional<SampleRange> samples;
    std::uint64_t seed = 0;
    BuildQuality build_quality = BuildQuality::high;
    std::optional<Traversal> traversal;
    std::vector<Aov> aovs;
    OutputSettings encoding;
    std::optional<std::uint64_t> max_memory;  ///< bytes
    bool dry_run = false;
};

/// Camera, size, depth, samples and seed. `options` has to outlive `command`, here and below.
void add_view_options(CLI::App& command, RenderOptions& options);

/// The same and the crop.
void add_image_options(CLI::App& command, RenderOptions& options);

/// `--traversal`: how the tree is walked through.
void add_traversal_option(CLI::App& command, std::optional<Traversal>& traversal);

/// The same and how the tree is built.
void add_tree_options(CLI::App& command, BuildQuality& quality, std::optional<Traversal>& traversal);

/// `--aov`.
void add_aov_option(CLI::App& command, std::vector<Aov>& aovs);
/// `--transfer`, `--rounding`, `--exposure`, `--pixel-type` and `--compression`.
void add_encoding_options(CLI::App& command, OutputSettings& encoding);

void add_memory_limit(CLI::App& command, std::optional<std::uint64_t>& limit);

/// The scene, the images, their content and their encoding.
void add_render_options(CLI::App& command, RenderOptions& options);

}  // namespace sahl::cli
