#include "engine/scene/scene_merge.h"

#include <limits>

#include <fmt/format.h>

namespace sahl {
namespace {

template <typename T>
std::uint32_t append(std::vector<T>& all, const std::vector<T>& more) {
    const auto first = static_cast<std::uint32_t>(all.size());
    all.insert(all.end(), more.begin(), more.end());
    return first;
}

// Appends the scene's lists, then renumbers what refers to them.
class Merge {
public:
    Merge(JsonSceneState& state, const Scene& from, const MergePlan& plan, const Surroundings& around)
        : state_(state), from_(from), plan_(plan), around_(around) {}

    void run() {
        append_materials();
        append_shapes();
        const std::uint32_t world_count = world_primitive_count(from_);
        first_group_ = static_cast<std::uint32_t>(state_.groups.size());
        add_placed(*around_.target, 0, world_count, from_.instances, around_.transform);
        for (const Group& group : from_.groups) {
            Placed placed;
            add_placed(placed, group.first_primitive, group.primitive_count, group.instances, glm::dmat4(1));
            state_.groups.push_back(std::move(placed));
            state_.group_names.push_back(group.name);
        }
    }

private:
    static constexpr std::uint32_t unknown = 0xffffffff;

    void append_materials() {
        std::vector<std::uint32_t> textures(from_.textures.size(), unknown);
        const auto move_texture = [&](std::uint32_t& texture) {
            if (texture == no_texture) return;
            if (textures[texture] == unknown) {
                textures[texture] = static_cast<std::uint32_t>(state_.scene.textures.size());
                state_.scene.textures.push_back(from_.textures[texture]);
            }
            texture = textures[texture];
        };
        materials_ = plan_.materials;
        for (std::size_t i = 0; i < from_.materials.size(); ++i) {
            if (materials_[i] != MergePlan::keep) continue;
            Material material = from_.materials[i];
            move_texture(material.textures.ambient);
            move_texture(material.textures.diffuse);
            move_texture(material.textures.specular);
            move_texture(material.textures.emission);
            move_texture(material.textures.reflection);
            materials_[i] = static_cast<std::uint32_t>(state_.scene.materials.size());
            state_.scene.materials.push_back(material);
        }
    }

    void append_shapes() {
        Scene& to = state_.scene;
        const std::uint32_t vertices = append(to.vertices, from_.vertices);
        const std::uint32_t normals = append(to.normals, from_.normals);
        const std::uint32_t uvs = append(to.uvs, from_.uvs);
        const std::uint32_t polygon_vertices = append(to.polygon_vertices, from_.polygon_vertices);
        first_of_[static_cast<std::size_t>(PrimitiveKind::sphere)] = append(to.spheres, from_.spheres);
        first_of_[static_cast<std::size_t>(PrimitiveKind::cone)] = append(to.cones, from_.cones);
        first_of_[static_cast<std::size_t>(PrimitiveKind::disc)] = append(to.discs, from_.discs);
        first_of_[static_cast<std::size_t>(PrimitiveKind::box)] = append(to.boxes, from_.boxes);
        const std::uint32_t triangles = append(to.triangles, from_.triangles);
        first_of_[static_cast<std::size_t>(PrimitiveKind::triangle)] = triangles;
        for (std::size_t i = triangles; i < to.triangles.size(); ++i) {
            Triangle& triangle = to.triangles[i];
            for (std::size_t k = 0; k < 3; ++k) {
                triangle.vertices[k] += vertices;
                if (triangle.smooth) triangle.normals[k] += normals;
                if (triangle.has_uv) triangle.uvs[k] += uvs;
            }
        }
        const std::uint32_t polygons = append(to.polygons, from_.polygons);
        first_of_[static_cast<std::size_t>(PrimitiveKind::polygon)] = polygons;
        for (std::size_t i = polygons; i < to.polygons.size(); ++i) {
            to.polygons[i].first_vertex += polygon_vertices;
        }
    }

    void add_placed(Placed& target, std::uint32_t first, std::uint32_t count,
                    const std::vector<Instance>& instances, const glm::dmat4& outer) {
        const SourceLocation where = state_.reader.place(*plan_.value);
        std::vector<std::uint32_t> transforms(from_.transforms.size(), unknown);
        const bool moves = outer != glm::dmat4(1);
        const auto transform = [&](std::uint32_t index) {
            if (transforms[index] == unknown) {
                const glm::dmat4& own = from_.transforms[index];
                if (moves) check_transform(outer * own, where);
                transforms[index] = add_transform(state_.scene, !moves       ? own
                                                                : index == 0 ? outer
                                                                             : outer * own);
            }
            return transforms[index];
        };
        for (std::uint32_t i = first; i < first + count; ++i) {
            Primitive primitive = from_.primitives[i];
            primitive.index += first_of_[static_cast<std::size_t>(primitive.kind)];
            primitive.material = materials_[primitive.material];
            primitive.transform = transform(primitive.transform);
            primitive.sides = plan_.sides.value_or(primitive.sides);
            if (moves) {
                check_placed(state_.scene, primitive, state_.scene.transforms[primitive.transform], where);
            }
            target.primitives.push_back(primitive);
        }
        for (const Instance& instance : instances) {
            target.instances.push_back({first_group_ + instance.group, transform(instance.transform)});
            target.instance_values.push_back(plan_.value);
        }
    }

    JsonSceneState& state_;
    const Scene& from_;
    const MergePlan& plan_;
    const Surroundings& around_;
    std::vector<std::uint32_t> materials_;            // their new indices
    std::uint32_t first_of_[6] = {0, 0, 0, 0, 0, 0};  // by PrimitiveKind
    std::uint32_t first_group_ = 0;
};

}  // namespace

void merge_scene(JsonSceneState& state, const Scene& scene, const MergePlan& plan,
                 const Surroundings& around) {
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() / 2;
    const Scene& to = state.scene;
    if (to.vertices.size() + scene.vertices.size() > most ||
        to.triangles.size() + scene.triangles.size() > most ||
        to.polygon_vertices.size() + scene.polygon_vertices.size() > most ||
        to.transforms.size() + scene.transforms.size() > most) {
        state.reader.fail(*plan.value, "the scene becomes too large; use instances of a group");
    }
    Merge(state, scene, plan, around).run();
}

}  // namespace sahl
