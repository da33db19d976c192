// What a profile says of where it was measured.
#pragma once

#include <string>

#include "engine/device/device.h"
#include "engine/profile/profile.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Fills in what the device, the processor and the kernels say of themselves.
void describe_device(const Device& device, ProfileEnvironment& environment);

/// Of the scene and the camera that is used, as 16 hexadecimal digits: the same for the same image.
std::string scene_hash(const Scene& scene, std::size_t camera);

}  // namespace sahl
