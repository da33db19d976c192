#include "engine/render/device_scene.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/host_scene.h"
#include "engine/render/leaf_blocks.h"

namespace sahl {
namespace {

template <class T>
Buffer upload(Device& device, const std::vector<T>& values, std::string name) {
    Buffer buffer(device, values.size() * sizeof(T), std::move(name));
    buffer.write(std::span<const T>(values));
    return buffer;
}

}  // namespace

DeviceScene make_device_scene(Device& device, const Scene& scene) {
    const HostScene host = make_host_scene(scene);
    DeviceScene out;
    out.nodes = upload(device, host.bvh.nodes, "BVH nodes");
    out.leaves = Buffer(device, pack_leaf_blocks(device.memory(), scene, host), "leaf blocks");
    out.polygon_vertices = upload(device, host.lowered.polygon_vertices, "polygon vertices");
    out.instances = upload(device, host.instances, "instances");
    out.primitives = upload(device, host.lowered.primitives, "primitives");
    out.shape_data = upload(device, host.lowered.shape_data, "shape data");
    out.materials = upload(device, host.lowered.materials, "materials");
    out.textures = upload(device, host.lowered.textures, "textures");
    out.lights = upload(device, host.lowered.lights, "lights");
    out.constants = host.constants;
    out.bvh_statistics = host.bvh.statistics;
    return out;
}

}  // namespace sahl
