#include "engine/render/scene_info.h"

#include <optional>

#include "engine/render/host_scene.h"

namespace sahl {
namespace {

MemoryPlan memory_of(const Scene& scene, const HostScene& host) {
    MemoryRequest request;
    request.pixels = static_cast<std::uint64_t>(scene.resolution.width) *
                     static_cast<std::uint64_t>(scene.resolution.height);
    request.samples = request.pixels;
    request.depth = scene.depth;
    request.light_count = host.constants.light_count;
    request.ray_budget = RenderSettings{}.ray_budget;
    return plan_memory(measure_scene_memory(scene, host, bound_scene_memory(scene)), request, UINT64_MAX);
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
    info.memory = memory_of(scene, host);
    return info;
}

}  // namespace sahl
