#include "engine/render/device_scene.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/host_steps.h"
#include "engine/render/host_scene.h"
#include "engine/render/leaf_blocks.h"

namespace sahl {
namespace {

/// Moves the host's arrays to a device, one after the other, so that only one at a time is on both.
class Uploader {
public:
    Uploader(Device& device, MemoryReservation& host) : device_(device), host_(host) {}

    template <class Vector>
    Buffer move(Vector& values, std::string name) {
        const std::size_t bytes = values.size() * sizeof(typename Vector::value_type);
        Buffer buffer(device_, bytes, std::move(name));
        buffer.write(std::span(std::as_const(values)));
        values = Vector();  // = {} would keep the memory
        host_.give_back(bytes);
        return buffer;
    }

private:
    Device& device_;
    MemoryReservation& host_;
};

/// What Uploader gives back, and the trees' leaves.
std::uint64_t bytes_of(const HostScene& host) {
    const auto bytes = [](const auto& values) { return std::span(values).size_bytes(); };
    const LoweredScene& lowered = host.lowered;
    return bytes(host.bvh.nodes) + bytes(host.bvh.leaves) + bytes(host.instances) +
           bytes(lowered.primitives) + bytes(lowered.shape_data) + bytes(lowered.outlines) +
           bytes(lowered.materials) + bytes(lowered.textures) + bytes(lowered.lights);
}

}  // namespace

DeviceScene make_device_scene(Device& device, const Scene& scene, const MemoryRequest& job,
                              BuildQuality quality) {
    MemoryAccountant& accountant = device.memory();
    const SceneMemory bound = check_room_to_build(scene, job, accountant.limit());
    MemoryReservation held(accountant, bound.loaded + bound.building, "the scene and its trees");
    HostScene host = make_host_scene(scene, quality);
    DeviceScene out;
    out.plan = plan_memory(measure_scene_memory(scene, host, bound), job, accountant.limit());
    held.give_back(bound.building);

    const HostStep step("upload");
    MemoryReservation building(accountant, bytes_of(host), "the scene for the device");
    Uploader upload(device, building);
    out.nodes = upload.move(host.bvh.nodes, "BVH nodes");
    out.leaves = Buffer(device, pack_leaf_blocks(accountant, scene, host), "leaf blocks");
    out.outlines = upload.move(host.lowered.outlines, "outlines of polygons");
    out.instances = upload.move(host.instances, "instances");
    out.primitives = upload.move(host.lowered.primitives, "primitives");
    out.shape_data = upload.move(host.lowered.shape_data, "shape data");
    out.materials = upload.move(host.lowered.materials, "materials");
    out.textures = upload.move(host.lowered.textures, "textures");
    out.lights = upload.move(host.lowered.lights, "lights");
    out.constants = host.constants;
    out.bvh_statistics = host.bvh.statistics;
    return out;
}

}  // namespace sahl
