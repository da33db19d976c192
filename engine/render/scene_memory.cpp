#include "engine/render/scene_memory.h"

#include <algorithm>
#include <vector>

#include "engine/accel/binary_tree.h"
#include "engine/device/buffer.h"
#include "engine/render/host_scene.h"
#include "engine/render/place_instances.h"

namespace sahl {
namespace {

template <class T>
std::uint64_t held(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}

/// Of a device buffer of `count` elements.
template <class T>
std::uint64_t footprint(std::uint64_t count) {
    return Buffer::footprint(count * sizeof(T));
}

std::uint64_t loaded_bytes(const Scene& scene) {
    std::uint64_t groups = held(scene.groups);
    for (const Group& group : scene.groups) groups += held(group.instances) + group.name.capacity();
    std::uint64_t names = 0;
    for (const Material& material : scene.materials) names += material.name.capacity();
    return held(scene.cameras) + held(scene.lights) + held(scene.materials) + names + held(scene.textures) +
           held(scene.transforms) + held(scene.primitives) + held(scene.instances) + groups +
           held(scene.triangles) + held(scene.polygons) + held(scene.spheres) + held(scene.cones) +
           held(scene.discs) + held(scene.boxes) + held(scene.vertices) + held(scene.normals) +
           held(scene.uvs) + held(scene.polygon_vertices);
}

/// All of a scene but its trees.
SceneMemory shading_memory(const Scene& scene, std::uint64_t shape_data, std::uint64_t instances) {
    SceneMemory memory;
    memory.loaded = loaded_bytes(scene);
    memory.shapes = footprint<device::DevicePrimitive>(scene.primitives.size()) +
                    footprint<float>(shape_data) + footprint<float>(outline_floats(scene));
    memory.instances = footprint<device::DeviceInstance>(instances);
    memory.materials = footprint<device::DeviceMaterial>(scene.materials.size()) +
                       footprint<device::DeviceTexture>(scene.textures.size()) +
                       footprint<device::DeviceLight>(scene.lights.size());
    return memory;
}

/// The most lines of a leaf block for one primitive.
std::uint64_t most_lines(PrimitiveKind kind) {
    switch (kind) {
        case PrimitiveKind::triangle:
            return block_lines(SAHL_KIND_TRIANGLE);
        case PrimitiveKind::polygon:
            return block_lines(SAHL_KIND_POLYGON);
        default:
            return block_lines(SAHL_KIND_ELLIPSOID);
    }
}

}  // namespace

SceneMemory bound_scene_memory(const Scene& scene) {
    const std::uint64_t placed = count_placed_instances(scene);
    const std::uint64_t items = scene.primitives.size() + placed;
    const std::uint64_t references = most_references(items);
    const std::uint64_t nodes = most_nodes(items) + scene.groups.size() + 1;
    std::uint64_t lines = (references - items) * block_lines(SAHL_KIND_TRIANGLE);  // only triangles are cut
    for (const Primitive& primitive : scene.primitives) lines += most_lines(primitive.kind);

    SceneMemory memory = shading_memory(scene, most_shape_data(scene), placed);
    memory.nodes = footprint<device::BvhNode>(nodes);
    memory.leaf_blocks = Buffer::footprint(lines * SAHL_LEAF_LINE_BYTES);
    // The trees of groups are built apart and then joined with the world's.
    const std::uint64_t copies = scene.groups.empty() ? 1 : 2;
    const std::uint64_t host = memory.shapes + memory.instances + memory.materials +
                               copies * (memory.nodes + references * sizeof(BvhLeaf));
    // The builder's primitives, the references of one tree and its binary nodes.
    const std::uint64_t builder = references * (2 * sizeof(BuildPrimitive) + sizeof(BinaryNode)) +
                                  placed * (sizeof(PlacedGroup) + sizeof(BuildPrimitive));
    // Of the host's arrays one at a time is there on the device as well.
    memory.building =
        host + std::max({builder, memory.nodes, memory.leaf_blocks, memory.shapes, memory.instances});
    return memory;
}

SceneMemory measure_scene_memory(const Scene& scene, const HostScene& host, const SceneMemory& bound) {
    SceneMemory memory = shading_memory(scene, host.lowered.shape_data.size(), host.instances.size());
    memory.nodes = footprint<device::BvhNode>(host.bvh.nodes.size());
    memory.leaf_blocks = Buffer::footprint(std::uint64_t{host.bvh.leaf_lines} * SAHL_LEAF_LINE_BYTES);
    memory.building = bound.building;
    return memory;
}

}  // namespace sahl
