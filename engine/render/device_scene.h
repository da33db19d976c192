// A scene in device buffers, as the kernels take it.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/device/buffer.h"
#include "engine/scene/scene.h"
#include "kernels/device_types.h"

namespace sahl {

struct DeviceScene {
    Buffer nodes;
    Buffer leaves;
    Buffer polygon_vertices;
    Buffer primitives;
    Buffer shape_data;
    Buffer materials;
    Buffer lights;
    device::SceneConstants constants{};
    BvhStatistics bvh_statistics;
};

/// Lowers the scene, builds its BVH and uploads both. Errors as lower_scene, build_bvh and Buffer.
DeviceScene make_device_scene(Device& device, const Scene& scene);

}  // namespace sahl
