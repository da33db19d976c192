#include "engine/render/place_instances.h"

#include <optional>
#include <string>

#include "engine/core/error.h"
#include "kernels/device_types.h"

namespace sahl {
namespace {

constexpr int max_nesting = 64;
constexpr std::uint64_t max_instances = SAHL_CHILD_OFFSET_MASK;

/// Counts before anything is placed: a few nested groups can make more instances than atoms.
class InstanceCounter {
public:
    explicit InstanceCounter(const Scene& scene) : scene_(scene), counts_(scene.groups.size()) {}

    std::uint64_t count(const std::vector<Instance>& instances, int nesting) {
        if (nesting > max_nesting) {
            throw Error(ExitCode::scene, "groups are nested deeper than " + std::to_string(max_nesting) +
                                             "; nest fewer (or does one contain itself?)");
        }
        std::uint64_t sum = 0;
        for (const Instance& instance : instances) {
            std::optional<std::uint64_t>& inside = counts_[instance.group];
            if (!inside) inside = count(scene_.groups[instance.group].instances, nesting + 1);
            sum += 1 + *inside;
            if (sum > max_instances) {
                throw Error(ExitCode::scene, "the scene has more than " + std::to_string(max_instances) +
                                                 " instances, the most there can be; instance fewer");
            }
        }
        return sum;
    }

private:
    const Scene& scene_;
    std::vector<std::optional<std::uint64_t>> counts_;
};

void place(const Scene& scene, const std::vector<Instance>& instances, const glm::dmat4& world_from_parent,
           std::vector<PlacedGroup>& placed) {
    for (const Instance& instance : instances) {
        const glm::dmat4 world_from_group = world_from_parent * scene.transforms[instance.transform];
        placed.push_back({instance.group, world_from_group});
        place(scene, scene.groups[instance.group].instances, world_from_group, placed);
    }
}

}  // namespace

std::uint64_t count_placed_instances(const Scene& scene) {
    return InstanceCounter(scene).count(scene.instances, 0);
}

std::vector<PlacedGroup> place_instances(const Scene& scene) {
    std::vector<PlacedGroup> placed;
    placed.reserve(count_placed_instances(scene));
    place(scene, scene.instances, glm::dmat4(1), placed);
    return placed;
}

}  // namespace sahl
