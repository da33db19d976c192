// What of a scene is to be rendered, by the command line's options.
#pragma once

#include "cli/render_options.h"

namespace sahl::cli {

/// All but the depth. Throws Error(usage) for what the scene or the image does not have.
RenderSettings settings_of(const RenderOptions& options, const Scene& scene);

/// The crop's, if there is one.
Resolution image_size(const RenderSettings& settings);

/// Of each pixel.
inline int sample_count(const RenderSettings& settings) {
    return settings.samples ? settings.samples->count() : settings.spp;
}

}  // namespace sahl::cli
