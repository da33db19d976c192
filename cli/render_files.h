// The files of a rendered image, finished or interrupted.
#pragma once

#include <span>

#include "cli/render_report.h"

namespace sahl::cli {

/// Writes `outputs` of `result`; those with room for them get `aovs` too. Throws as write_image.
void write_files(const Rendered& result, std::span<const Output> outputs, const Image& image,
                 std::span<const AovImage> aovs, const RenderOptions& options, const DeviceInfo& device);

/// Writes what is finished of `result` to `NAME.partial.EXT` beside each of its files, but for special
/// ones such as /dev/null, and throws Interrupted, which names them. The files themselves stay as they
/// are. Where no pixel is finished, nothing is written.
[[noreturn]] void save_partial(const Rendered& result, const Image& image, std::span<const AovImage> aovs,
                               const RenderOptions& options, const DeviceInfo& device);

}  // namespace sahl::cli
