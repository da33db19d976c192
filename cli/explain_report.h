// What `sahl explain` says of a pixel: its ray tree as text or as an event.
#pragma once

#include <string>

#include "cli/render_options.h"
#include "engine/render/explanation.h"

namespace sahl::cli {

/// A pixel of an image, explained.
struct ExplainedPixel {
    const Scene& scene;
    const RenderOptions& options;
    const RenderSettings& settings;
    int x = 0, y = 0;
    Explanation explanation;
};

/// The tree, a line a ray, and the sums of its generations.
std::string explanation_text(const ExplainedPixel& pixel);

/// All there is of each ray.
void print_explanation(const ExplainedPixel& pixel);

}  // namespace sahl::cli
