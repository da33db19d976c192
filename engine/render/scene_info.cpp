#include "engine/render/scene_info.h"

#include <algorithm>
#include <optional>

#include "engine/render/host_scene.h"
#include "engine/render/ray_queues.h"
#include "engine/render/renderer.h"

namespace sahl {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

MemoryPlan plan_memory(const Scene& scene, const HostScene& host) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(scene.resolution.width) *
                                 static_cast<std::uint64_t>(scene.resolution.height);
    const auto rays =
        static_cast<std::uint32_t>(std::min(std::uint64_t{RenderSettings{}.ray_budget}, pixels));
    const LoweredScene& lowered = host.lowered;
    MemoryPlan plan;
    plan.nodes = bytes_of(host.bvh.nodes);
    plan.leaf_blocks = std::uint64_t{host.bvh.leaf_lines} * SAHL_LEAF_LINE_BYTES;
    plan.shapes =
        bytes_of(lowered.primitives) + bytes_of(lowered.shape_data) + bytes_of(lowered.polygon_vertices);
    plan.instances = bytes_of(host.instances);
    plan.materials = bytes_of(lowered.materials) + bytes_of(lowered.textures) + bytes_of(lowered.lights);
    plan.ray_queues = ray_queue_bytes(rays, scene.depth, host.constants.light_count);
    plan.film = film_bytes(scene.resolution.width, scene.resolution.height);
    return plan;
}

/// Primitives of groups with those of the groups placed inside.
class PlacedPrimitives {
public:
    explicit PlacedPrimitives(const Scene& scene) : scene_(scene), counts_(scene.groups.size()) {}

    std::uint64_t of(const std::vector<Instance>& instances) {
        std::uint64_t sum = 0;
        for (const Instance& instance : instances) {
            std::optional<std::uint64_t>& count = counts_[instance.group];
            if (!count) {
                const Group& group = scene_.groups[instance.group];
                count = group.primitive_count + of(group.instances);
            }
            sum += *count;
        }
        return sum;
    }

    /// Whether the group has been met.
    bool reached(std::size_t group) const { return counts_[group].has_value(); }

private:
    const Scene& scene_;
    std::vector<std::optional<std::uint64_t>> counts_;
};

std::string name_or_number(const std::string& name, std::size_t index) {
    return name.empty() ? "#" + std::to_string(index) : name;
}

std::vector<std::string> find_unused_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size());
    for (const Primitive& primitive : scene.primitives) used[primitive.material] = true;
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) unused.push_back(name_or_number(scene.materials[i].name, i));
    }
    return unused;
}

}  // namespace

SceneInfo describe_scene(const Scene& scene) {
    const HostScene host = make_host_scene(scene);
    SceneInfo info;
    for (const Primitive& primitive : scene.primitives)
        ++info.primitives[static_cast<std::size_t>(primitive.kind)];
    for (const Light& light : scene.lights) ++info.lights[static_cast<std::size_t>(light.kind)];

    info.instances = scene.instances.size();
    for (const Group& group : scene.groups) info.instances += group.instances.size();
    info.placed_instances = host.instances.size();
    PlacedPrimitives placed(scene);
    info.placed_primitives = world_primitive_count(scene) + placed.of(scene.instances);
    for (std::size_t i = 0; i < scene.groups.size(); ++i) {
        if (placed.reached(i)) {
            ++info.trees;
        } else {
            info.unused_groups.push_back(name_or_number(scene.groups[i].name, i));
        }
    }
    info.unused_materials = find_unused_materials(scene);

    info.bounds = host.bvh.bounds;
    info.bvh = host.bvh.statistics;
    info.nodes = host.bvh.nodes.size();
    info.leaves = host.bvh.leaves.size();
    info.memory = plan_memory(scene, host);
    return info;
}

}  // namespace sahl
