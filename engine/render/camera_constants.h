// A camera as the kernels take it.
#pragma once

#include "engine/scene/scene.h"
#include "kernels/device_types.h"

namespace sahl {

/// The camera's frame and pixel steps: w = norm(eye - look_at), u = norm(up x w), v = w x u.
device::CameraConstants camera_constants(const Camera& camera, const Resolution& resolution);

}  // namespace sahl
