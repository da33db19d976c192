// The scene of a profile, made ready for its device.
#pragma once

#include <memory>

#include "cli/profile_options.h"
#include "engine/profile/measure.h"

namespace sahl::cli {

/// The scene ready to be rendered, with all that happened until then.
struct Prepared {
    std::unique_ptr<Device> device;
    std::unique_ptr<Renderer> renderer;
    FrameJob job;
    Measurement measurement;  ///< of it the setup and what is known of the environment
};

/// Loads the scene and makes a renderer of it, recorded from the start. Throws Error as all of that does, and
/// Error(usage) for what cannot be profiled.
Prepared prepare(const ProfileOptions& options, const CommonOptions& common);

/// Throws Interrupted when a signal has come.
void check_interruption();

}  // namespace sahl::cli
