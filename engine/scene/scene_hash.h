// Whether two scenes, or what a camera sees of them, are the same.
#pragma once

#include <cstdint>

#include "engine/scene/scene.h"

namespace sahl {

/// Of all that becomes device data: everything but cameras, resolution, depth and names. Equal scenes have
/// equal hashes; of 2^32 scenes two different ones may meet.
std::uint64_t hash_without_cameras(const Scene& scene);

/// Of that and one camera, whatever its name.
std::uint64_t hash_with_camera(const Scene& scene, const Camera& camera);

}  // namespace sahl
