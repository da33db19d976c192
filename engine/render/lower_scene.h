// From Scene to the arrays that kernels read: shapes in the space of the world or their group,
// materials, lights, and what the BVH builder needs of each primitive.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/scene/scene.h"
#include "kernels/device_types.h"

namespace sahl {

struct LoweredScene {
    std::vector<device::DevicePrimitive> primitives;  ///< by id
    std::vector<float> shape_data;                    ///< as device_types.h lays it out
    std::vector<float> outlines;                      ///< of polygons: OutlineGroups
    std::vector<device::DeviceMaterial> materials;
    std::vector<device::DeviceTexture> textures;
    std::vector<device::DeviceLight> lights;
    std::vector<BuildPrimitive> build_primitives;  ///< by id
};

/// Transforms are applied in double precision and rounded once; normals go by the inverse
/// transpose, so that outward stays outward under mirroring transforms too.
/// Throws Error(scene) when there are more primitives than ids or their world coordinates are not
/// finite.
LoweredScene lower_scene(const Scene& scene);

/// Floats of LoweredScene::outlines.
std::size_t outline_floats(const Scene& scene);

/// As many floats as LoweredScene::shape_data has for `scene`, or more.
std::size_t most_shape_data(const Scene& scene);

/// The word that stands for primitive `id` in a leaf block (SAHL_ID_*).
std::uint32_t block_id(const Scene& scene, std::uint32_t id);

}  // namespace sahl
