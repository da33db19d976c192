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
    Buffer instances;
    Buffer primitives;
    Buffer shape_data;
    Buffer materials;
    Buffer textures;
    Buffer lights;
    device::SceneConstants constants{};
    BvhStatistics bvh_statistics;
};

/// Uploads what make_host_scene makes of the scene. Errors as there and of Buffer.
DeviceScene make_device_scene(Device& device, const Scene& scene);

}  // namespace sahl
