#include "engine/scene/scene_json_objects.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/nearest.h"
#include "engine/scene/scene_json_includes.h"
#include "engine/scene/scene_json_materials.h"
#include "engine/scene/scene_json_mesh.h"
#include "engine/scene/scene_json_transform.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

constexpr std::array<std::string_view, 4> common_keys = {"type", "material", "transform", "sides"};

void add(JsonSceneState& state, const JsonObject& object, const Surroundings& around, PrimitiveKind kind,
         std::size_t index) {
    const Primitive primitive{kind, static_cast<std::uint32_t>(index), *around.material,
                              add_transform(state.scene, around.transform), around.sides};
    check_placed(state.scene, primitive, around.transform, object.place());
    around.target->primitives.push_back(primitive);
}

// What holds inside an object: its own keys over those of the objects around it.
Surroundings inside(JsonSceneState& state, const JsonObject& object, const Surroundings& around) {
    Surroundings own = around;
    if (const JsonValue* transform = object.find("transform")) {
        const glm::dmat4 m = read_transform(state.reader, *transform);
        const bool nested = around.transform != glm::dmat4(1);
        own.transform = nested ? around.transform * m : m;
        if (nested) check_transform(own.transform, state.reader.place(*transform));
    }
    if (const JsonValue* material = object.find("material")) {
        own.material = read_material_reference(state, *material);
    }
    if (const JsonValue* sides = object.find("sides")) {
        constexpr std::array<std::string_view, 3> names = {"both", "front", "back"};
        own.sides = static_cast<Sides>(state.reader.choice(*sides, "sides", "sides", names));
    }
    return own;
}

Surroundings inside_shape(JsonSceneState& state, const JsonObject& object, const Surroundings& around) {
    Surroundings own = inside(state, object, around);
    if (!own.material) own.material = default_material(state);
    return own;
}

void read_sphere(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "sphere", {}, {"center", "radius"}, common_keys);
    const Surroundings own = inside_shape(state, object, around);
    Sphere sphere;
    sphere.center = object.vector("center", glm::dvec3(0));
    sphere.radius = object.number("radius", 1, positive_length);
    state.scene.spheres.push_back(sphere);
    add(state, object, own, PrimitiveKind::sphere, state.scene.spheres.size() - 1);
}

void read_box(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "box", {"min", "max"}, {}, common_keys);
    const Surroundings own = inside_shape(state, object, around);
    const Box box{object.vector("min", {}), object.vector("max", {})};
    for (int axis = 0; axis < 3; ++axis) {
        if (box.hi[axis] - box.lo[axis] < min_length) {
            state.reader.fail(
                object.at("max"),
                fmt::format("the box's max {0} must be greater than its min {0} by at least {1:g}",
                            "xyz"[axis], min_length));
        }
    }
    state.scene.boxes.push_back(box);
    add(state, object, own, PrimitiveKind::box, state.scene.boxes.size() - 1);
}

void read_disc(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "disc", {}, {"center", "normal", "radius"}, common_keys);
    const Surroundings own = inside_shape(state, object, around);
    Disc disc;
    disc.center = object.vector("center", glm::dvec3(0));
    disc.normal = glm::normalize(object.direction("normal", {0, 0, 1}));
    disc.radius = object.number("radius", 1, positive_length);
    state.scene.discs.push_back(disc);
    add(state, object, own, PrimitiveKind::disc, state.scene.discs.size() - 1);
}

void add_cone(JsonSceneState& state, const JsonObject& object, const Surroundings& around, const Cone& cone) {
    if (glm::length(cone.apex - cone.base) < min_length) {
        state.reader.fail(object.at("top"), "'top' is where 'base' is; give it a height");
    }
    state.scene.cones.push_back(cone);
    add(state, object, around, PrimitiveKind::cone, state.scene.cones.size() - 1);
}

void read_cylinder(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "cylinder", {"base", "top"}, {"radius", "capped"},
                            common_keys);
    const Surroundings own = inside_shape(state, object, around);
    const double radius = object.number("radius", 1, positive_length);
    add_cone(state, object, own,
             {object.vector("base", {}), object.vector("top", {}), radius, radius,
              object.boolean("capped", true)});
}

// One radius of a cone may be 0, but none so small that its square vanishes.
double read_radius(const JsonObject& object, std::string_view key, double otherwise) {
    const double radius = object.number(key, otherwise, not_negative);
    return radius == 0 ? 0 : object.number(key, otherwise, positive_length);
}

void read_cone(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "cone", {"base", "top"},
                            {"base_radius", "top_radius", "capped"}, common_keys);
    const Surroundings own = inside_shape(state, object, around);
    const Cone cone{object.vector("base", {}), object.vector("top", {}),
                    read_radius(object, "base_radius", 1), read_radius(object, "top_radius", 0),
                    object.boolean("capped", true)};
    if (cone.base_radius == 0 && cone.apex_radius == 0) {
        state.reader.fail(object.at("base_radius"), "both radii of the cone are 0; at most one may be");
    }
    add_cone(state, object, own, cone);
}

void read_polygon_object(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "polygon", {"vertices"}, {}, common_keys);
    read_polygon(state, object, inside_shape(state, object, around));
}

void read_mesh_object(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "mesh", {"vertices", "triangles"}, {"normals", "uv"},
                            common_keys);
    read_mesh(state, object, inside_shape(state, object, around));
}

void read_group(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "group", {"objects"}, {}, common_keys);
    read_objects(state, object.at("objects"), inside(state, object, around));
}

void read_instance(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "instance", {"group"}, {"type", "transform"});
    const Surroundings own = inside(state, object, around);
    const JsonValue& group = object.at("group");
    const std::string_view name = state.reader.text(group, "group");
    const auto found = state.own_groups.find(name);
    if (found == state.own_groups.end()) {
        state.reader.fail(group, fmt::format("there is no group {}{}", in_quotes(name),
                                             suggest(name, "groups", names_of(state.own_groups))));
    }
    own.target->instances.push_back({found->second, add_transform(state.scene, own.transform)});
    own.target->instance_values.push_back(&value);
}

void read_include_object(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonObject object(state.reader, value, "include", {"uri"},
                            {"materials", "set", "lights", "cameras"}, common_keys);
    // An included scene has materials and sides of its own: only what the include itself says replaces them.
    Surroundings own = around;
    own.material.reset();
    read_include(state, object, inside(state, object, own));
}

struct ObjectType {
    std::string_view name;
    void (*read)(JsonSceneState&, const JsonValue&, const Surroundings&);
};

constexpr std::array<ObjectType, 10> object_types = {{{"sphere", read_sphere},
                                                      {"box", read_box},
                                                      {"disc", read_disc},
                                                      {"cylinder", read_cylinder},
                                                      {"cone", read_cone},
                                                      {"polygon", read_polygon_object},
                                                      {"mesh", read_mesh_object},
                                                      {"group", read_group},
                                                      {"instance", read_instance},
                                                      {"include", read_include_object}}};

}  // namespace

std::uint32_t add_transform(Scene& scene, const glm::dmat4& m) {
    if (m == glm::dmat4(1)) return 0;
    // To the bit: zeros have signs.
    using Bits = std::array<std::uint64_t, 16>;
    if (std::bit_cast<Bits>(scene.transforms.back()) != std::bit_cast<Bits>(m)) scene.transforms.push_back(m);
    return static_cast<std::uint32_t>(scene.transforms.size() - 1);
}

void read_objects(JsonSceneState& state, const JsonValue& value, const Surroundings& around) {
    const JsonReader& reader = state.reader;
    for (const JsonValue& element : reader.array(value, "objects", "an array of objects")) {
        const std::span<const JsonMember> members = reader.members(element, "object");
        const auto type =
            std::find_if(members.begin(), members.end(), [](const JsonMember& m) { return m.key == "type"; });
        constexpr auto names = [] {
            std::array<std::string_view, object_types.size()> all;
            for (std::size_t i = 0; i < all.size(); ++i) all[i] = object_types[i].name;
            return all;
        }();
        if (type == members.end()) {
            reader.fail(element, fmt::format("this object has no 'type'; types are {}", join_names(names)));
        }
        object_types[reader.choice(type->value, "type", "types", names)].read(state, element, around);
    }
}

}  // namespace sahl
