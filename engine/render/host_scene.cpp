#include "engine/render/host_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/core/error.h"
#include "engine/core/host_steps.h"
#include "engine/render/place_instances.h"
#include "engine/render/two_floats.h"
#include "engine/scene/validate.h"

namespace sahl {
namespace {

float largest_coordinate(const Bounds& bounds) {
    float extent = 0;
    for (int k = 0; k < 3; ++k) {
        extent = std::max({extent, std::abs(bounds.lo[k]), std::abs(bounds.hi[k])});
    }
    return extent;
}

/// The trees of groups, each built when it is first wanted.
class GroupTrees {
public:
    GroupTrees(const Scene& scene, std::span<const BuildPrimitive> primitives, const TriangleCorners& corners,
               BuildQuality quality)
        : scene_(scene),
          primitives_(primitives),
          corners_(corners),
          quality_(quality),
          trees_(scene.groups.size()) {}

    const Bvh& of(std::uint32_t group) {
        std::optional<Bvh>& tree = trees_[group];
        if (!tree) {
            const Group& g = scene_.groups[group];
            const auto range = primitives_.subspan(g.first_primitive, g.primitive_count);
            std::vector<BuildPrimitive> primitives;
            primitives.reserve(most_references(range.size()));
            primitives.assign(range.begin(), range.end());
            tree = build_bvh(std::move(primitives), corners_, quality_);
        }
        return *tree;
    }

    /// Moves the trees behind `forest`'s; the roots by group.
    std::vector<std::uint32_t> append_to(Bvh& forest) {
        std::vector<std::uint32_t> roots(trees_.size(), 0);
        for (std::size_t group = 0; group < trees_.size(); ++group) {
            if (!trees_[group]) continue;
            roots[group] = append_tree(forest, *trees_[group]);
            trees_[group].reset();
        }
        return roots;
    }

private:
    const Scene& scene_;
    std::span<const BuildPrimitive> primitives_;
    TriangleCorners corners_;
    BuildQuality quality_;
    std::vector<std::optional<Bvh>> trees_;
};

/// A box in the world around a group's. The margin covers that rays are rounded to single precision
/// in the group's space, which an unequal scale magnifies.
Bounds world_bounds(const Bounds& bounds, const glm::dmat4& world_from_group, double condition) {
    constexpr double slack = 0x1p-21;
    const glm::dmat3 linear(world_from_group);
    glm::dvec3 lo, hi;
    for (int k = 0; k < 3; ++k) {
        lo[k] = static_cast<double>(bounds.lo[k]);
        hi[k] = static_cast<double>(bounds.hi[k]);
    }
    const glm::dvec3 center(world_from_group * glm::dvec4((lo + hi) / 2.0, 1));
    glm::dvec3 half(0);
    for (int axis = 0; axis < 3; ++axis) half += glm::abs(linear[axis]) * ((hi[axis] - lo[axis]) / 2);
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(center[k]) + half[k]);
    Bounds out{};
    for (int k = 0; k < 3; ++k) {
        out.lo[k] = static_cast<float>(center[k] - half[k] - slack * condition * reach);
        out.hi[k] = static_cast<float>(center[k] + half[k] + slack * condition * reach);
    }
    return out;
}

/// How much longer than its shortest axis a unit ball's longest becomes, at most.
double condition_of(const glm::dmat3& linear, const glm::dmat3& inverse) {
    const auto largest = [](const glm::dmat3& m) {
        double norm2 = 0;
        for (int axis = 0; axis < 3; ++axis) norm2 = std::max(norm2, glm::dot(m[axis], m[axis]));
        return std::sqrt(norm2);
    };
    return 3 * largest(linear) * largest(inverse);
}

device::DeviceInstance lower_instance(const glm::dmat4& group_from_world, const Bounds& bounds) {
    device::DeviceInstance out{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            const TwoFloats parts = split(group_from_world[column][row]);
            out.rows[row][column] = parts.high;
            out.rows[row][column + 4] = parts.low;
        }
    }
    out.extent = largest_coordinate(bounds);
    return out;
}

bool is_finite(const Bounds& bounds) {
    const auto finite = [](float x) { return std::isfinite(x); };
    return std::all_of(std::begin(bounds.lo), std::end(bounds.lo), finite) &&
           std::all_of(std::begin(bounds.hi), std::end(bounds.hi), finite);
}

}  // namespace

HostScene make_host_scene(const Scene& scene, BuildQuality quality) {
    const HostStep step("build BVH");
    HostScene out;
    out.lowered = lower_scene(scene);
    std::vector<BuildPrimitive> primitives = std::exchange(out.lowered.build_primitives, {});
    const std::vector<PlacedGroup> placed = place_instances(scene);
    std::vector<BuildPrimitive> placed_boxes;
    placed_boxes.reserve(placed.size());

    const TriangleCorners corners{out.lowered.shape_data.data(), out.lowered.primitives.data()};
    GroupTrees trees(scene, primitives, corners, quality);
    out.instances.reserve(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const PlacedGroup& instance = placed[i];
        const Group& group = scene.groups[instance.group];
        const auto fail = [&](const char* what) {
            throw Error(ExitCode::scene, "instance " + std::to_string(i + 1) + " (of group '" + group.name +
                                             "') " + what + "; check its transforms");
        };
        if (!is_invertible(instance.world_from_group)) fail("is flattened: its transforms have no inverse");
        const glm::dmat4 group_from_world = glm::inverse(instance.world_from_group);
        const Bounds bounds = trees.of(instance.group).bounds;
        out.instances.push_back(lower_instance(group_from_world, bounds));
        if (group.primitive_count == 0) continue;
        const double condition =
            condition_of(glm::dmat3(instance.world_from_group), glm::dmat3(group_from_world));
        const Bounds box = world_bounds(bounds, instance.world_from_group, condition);
        if (!is_finite(box)) fail("has no finite place in the world");
        placed_boxes.push_back({box, SAHL_KIND_INSTANCE, static_cast<std::uint32_t>(i)});
    }

    primitives.resize(world_primitive_count(scene));
    primitives.reserve(most_references(primitives.size() + placed_boxes.size()));
    primitives.insert(primitives.end(), placed_boxes.begin(), placed_boxes.end());
    placed_boxes = std::vector<BuildPrimitive>();  // = {} would keep the memory
    const bool empty = primitives.empty();
    out.bvh = build_bvh(std::move(primitives), corners, quality);
    const std::vector<std::uint32_t> roots = trees.append_to(out.bvh);
    for (std::size_t i = 0; i < placed.size(); ++i) out.instances[i].root = roots[placed[i].group];

    out.constants.background[0] = scene.background.x;
    out.constants.background[1] = scene.background.y;
    out.constants.background[2] = scene.background.z;
    out.constants.extent = empty ? 0.0F : largest_coordinate(out.bvh.bounds);
    out.constants.light_count = static_cast<std::uint32_t>(out.lowered.lights.size());
    return out;
}

}  // namespace sahl
