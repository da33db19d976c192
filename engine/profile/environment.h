// What a profile says of where it was measured.
#pragma once

#include "engine/device/device.h"
#include "engine/profile/profile.h"

namespace sahl {

/// Fills in what the device, the processor and the kernels say of themselves.
void describe_device(const Device& device, ProfileEnvironment& environment);

}  // namespace sahl
