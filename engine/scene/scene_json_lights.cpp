#include "engine/scene/scene_json_lights.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/nearest.h"
#include "engine/scene/scene_json_materials.h"

namespace sahl {
namespace {

void read_point(JsonSceneState& state, const JsonValue& value) {
    const JsonObject object(state.reader, value, "point light", {"type", "position"},
                            {"color", "attenuation"});
    Light light;
    light.kind = LightKind::point;
    light.position = object.vector("position", {});
    light.color = object.color("color", glm::dvec3(1));
    light.attenuation = read_attenuation(object);
    state.scene.lights.push_back(light);
}

void read_directional(JsonSceneState& state, const JsonValue& value) {
    const JsonObject object(state.reader, value, "directional light", {"type", "direction"}, {"color"});
    Light light;
    light.kind = LightKind::directional;
    light.position = glm::dvec3(0) - object.direction("direction", {});  // no negative zeros
    light.color = object.color("color", glm::dvec3(1));
    state.scene.lights.push_back(light);
}

void read_spot(JsonSceneState& state, const JsonValue& value) {
    const JsonObject object(state.reader, value, "spot light",
                            {"type", "position", "direction", "outer_angle"},
                            {"inner_angle", "color", "attenuation"});
    Light light;
    light.kind = LightKind::spot;
    light.position = object.vector("position", {});
    light.direction = glm::normalize(object.direction("direction", {}));
    light.outer_angle = object.number("outer_angle", 0);
    if (light.outer_angle <= 0 || light.outer_angle > 180) {
        state.reader.fail(object.at("outer_angle"),
                          fmt::format("'outer_angle' must be greater than 0 and at most 180, not {}",
                                      number_text(light.outer_angle)));
    }
    light.inner_angle = object.number("inner_angle", light.outer_angle, {0, light.outer_angle});
    light.color = object.color("color", glm::dvec3(1));
    light.attenuation = read_attenuation(object);
    state.scene.lights.push_back(light);
}

void read_ambient(JsonSceneState& state, const JsonValue& value) {
    const JsonObject object(state.reader, value, "ambient light", {"type", "color"});
    state.ambient = state.ambient.value_or(glm::vec3(0)) + glm::vec3(object.color("color", {}));
}

}  // namespace

void read_lights(JsonSceneState& state, const JsonValue& value) {
    constexpr std::array<std::string_view, 4> names = {"point", "directional", "spot", "ambient"};
    constexpr void (*read[])(JsonSceneState&, const JsonValue&) = {read_point, read_directional, read_spot,
                                                                   read_ambient};
    const JsonReader& reader = state.reader;
    for (const JsonValue& element : reader.array(value, "lights", "an array of lights")) {
        const std::span<const JsonMember> members = reader.members(element, "light");
        const auto type =
            std::find_if(members.begin(), members.end(), [](const JsonMember& m) { return m.key == "type"; });
        if (type == members.end()) {
            reader.fail(element, fmt::format("this light has no 'type'; types are {}", join_names(names)));
        }
        read[reader.choice(type->value, "type", "types", names)](state, element);
    }
}

}  // namespace sahl
