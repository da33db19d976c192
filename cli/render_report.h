// What `sahl render` says of its images: on standard error, as JSON events, in the files.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/render_options.h"

namespace sahl::cli {

/// One image to be.
struct Output {
    std::filesystem::path path;
    OutputSettings encoding;
};

/// All images of a run, before anything is traced.
struct Job {
    RenderSettings settings;                   ///< but for the depth
    std::vector<int> depths;                   ///< an image each
    std::vector<std::vector<Output>> outputs;  ///< for each depth
    std::string camera;
};

/// One finished image, in all its files.
struct Rendered {
    std::vector<Output> outputs;
    std::string camera;
    RenderSettings settings;
    Resolution size;  ///< of the file: the crop's
    RenderStatistics statistics;
    std::uint64_t non_finite = 0;
    std::uint64_t clamped = 0;
};

constexpr std::uint64_t pixel_count(const Resolution& size) {
    return std::uint64_t(size.width) * std::uint64_t(size.height);
}

/// Over all generations.
GenerationCounts total_rays(const RenderStatistics& statistics);

/// Whether rendering was interrupted before all pixels were finished.
bool is_partial(const Rendered& image);

/// The first event of `--json`.
void print_start(const RenderOptions& options, const Job& job, const DeviceInfo& device,
                 const BvhStatistics& bvh);

/// What `--dry-run` says: a text or an event on standard output.
void print_dry_run(const RenderOptions& options, const Job& job, const DeviceInfo& device,
                   const MemoryPlan& plan, std::uint64_t limit, bool json);

/// The event of a finished image.
void print_image(const Rendered& image);

/// The line of a finished image on standard error.
void say_image(const Rendered& image);

/// Warns of contributions that the film could not take as they were.
void warn_of_lost_light(const Rendered& image);

/// What the files say about themselves.
std::vector<std::pair<std::string, std::string>> metadata(const Rendered& image, const RenderOptions& options,
                                                          const DeviceInfo& device);

}  // namespace sahl::cli
