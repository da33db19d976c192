#include "engine/render/device_scene.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/leaf_blocks.h"
#include "engine/render/lower_scene.h"

namespace sahl {
namespace {

template <class T>
Buffer upload(Device& device, const std::vector<T>& values, std::string name) {
    Buffer buffer(device, values.size() * sizeof(T), std::move(name));
    buffer.write(std::span<const T>(values));
    return buffer;
}

float largest_coordinate(const Bounds& bounds) {
    float extent = 0;
    for (int k = 0; k < 3; ++k) {
        extent = std::max({extent, std::abs(bounds.lo[k]), std::abs(bounds.hi[k])});
    }
    return extent;
}

}  // namespace

DeviceScene make_device_scene(Device& device, const Scene& scene) {
    LoweredScene lowered = lower_scene(scene);
    const Bvh bvh = build_bvh(std::move(lowered.build_primitives));

    DeviceScene out;
    out.nodes = upload(device, bvh.nodes, "BVH nodes");
    out.leaves = Buffer(device, pack_leaf_blocks(device.memory(), scene, lowered, bvh), "leaf blocks");
    out.polygon_vertices = upload(device, lowered.polygon_vertices, "polygon vertices");
    out.primitives = upload(device, lowered.primitives, "primitives");
    out.shape_data = upload(device, lowered.shape_data, "shape data");
    out.materials = upload(device, lowered.materials, "materials");
    out.lights = upload(device, lowered.lights, "lights");
    out.constants.background[0] = scene.background.x;
    out.constants.background[1] = scene.background.y;
    out.constants.background[2] = scene.background.z;
    out.constants.extent = scene.primitives.empty() ? 0.0F : largest_coordinate(bvh.bounds);
    out.constants.light_count = static_cast<std::uint32_t>(lowered.lights.size());
    out.bvh_statistics = bvh.statistics;
    return out;
}

}  // namespace sahl
