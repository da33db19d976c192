// A scene in device buffers, as the kernels take it.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/device/buffer.h"
#include "engine/render/memory_plan.h"
#include "engine/scene/scene.h"
#include "kernels/device_types.h"

namespace sahl {

struct DeviceScene {
    Buffer nodes;
    Buffer leaves;
    Buffer outlines;
    Buffer instances;
    Buffer primitives;
    Buffer shape_data;
    Buffer materials;
    Buffer textures;
    Buffer lights;
    device::SceneConstants constants{};
    BvhStatistics bvh_statistics;
    MemoryPlan plan;  ///< of the scene and the job
};

/// Uploads what make_host_scene makes of the scene. The device's accountant counts the scene and what is
/// built of it on the host as well, and its limit has to leave room for `job`, see plan_memory(). Errors as
/// there, of make_host_scene and Buffer.
DeviceScene make_device_scene(Device& device, const Scene& scene, const MemoryRequest& job = {},
                              BuildQuality quality = BuildQuality::high);

}  // namespace sahl
