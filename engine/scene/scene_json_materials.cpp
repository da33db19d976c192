#include "engine/scene/scene_json_materials.h"

#include <array>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

constexpr Range positive_number{min_length, max_magnitude};

TextureSpace read_space(const JsonObject& texture, std::string_view pattern) {
    constexpr std::array<std::string_view, 2> spaces = {"position", "uv"};
    return texture.reader().choice(texture.at(pattern), pattern, "choices", spaces) == 0
               ? TextureSpace::position
               : TextureSpace::uv;
}

void read_colors(const JsonObject& object, Texture& texture) {
    const JsonReader& reader = object.reader();
    const JsonValue& value = object.at("colors");
    const auto colors = reader.array(value, "colors", "an array of 2 colours");
    if (colors.size() != 2) reader.fail_type(value, "colors", "an array of 2 colours");
    for (std::size_t i = 0; i < 2; ++i) texture.colors[i] = reader.color(colors[i], "colors");
}

Texture read_checker(const JsonReader& reader, const JsonValue& value) {
    const JsonObject object(reader, value, "checker", {"checker", "colors"}, {"size", "offset"});
    Texture texture;
    texture.pattern = Pattern::checker;
    texture.space = read_space(object, "checker");
    read_colors(object, texture);
    texture.origin = object.vector("offset", glm::dvec3(0));
    const JsonValue* size = object.find("size");
    if (size != nullptr && reader.is_number(*size)) {
        texture.extent = glm::dvec3(reader.number(*size, "size", positive_number));
    } else if (size != nullptr) {
        texture.extent = reader.vector(*size, "size", not_negative);
    }
    if (texture.space == TextureSpace::uv) texture.extent.z = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (texture.extent[axis] != 0 && texture.extent[axis] < min_length) texture.extent[axis] = min_length;
    }
    if (texture.extent == glm::dvec3(0)) {
        reader.fail(*size, "the checker's 'size' is zero on all axes; give one of them a size");
    }
    return texture;
}

Texture read_gradient(const JsonReader& reader, const JsonValue& value) {
    const JsonObject object(reader, value, "gradient", {"gradient", "colors", "to"}, {"from"});
    Texture texture;
    texture.pattern = Pattern::gradient;
    texture.space = read_space(object, "gradient");
    read_colors(object, texture);
    texture.origin = object.vector("from", glm::dvec3(0));
    texture.extent = object.vector("to", {}) - texture.origin;
    if (texture.space == TextureSpace::uv) {
        texture.origin.z = 0;
        texture.extent.z = 0;
    }
    if (glm::length(texture.extent) < min_length) {
        reader.fail(object.at("to"), "the gradient's 'to' is where 'from' is; move one of them");
    }
    return texture;
}

bool has_key(const JsonReader& reader, const JsonValue& object, std::string_view key) {
    for (const JsonMember& member : reader.document().members(object)) {
        if (member.key == key) return true;
    }
    return false;
}

// A colour, or white with a texture.
void read_channel(JsonSceneState& state, const JsonObject& object, std::string_view key, glm::vec3& color,
                  std::uint32_t& texture) {
    const JsonValue* value = object.find(key);
    if (value == nullptr) return;
    const JsonReader& reader = state.reader;
    if (value->kind != JsonKind::object) {
        color = reader.color(*value, key);
        return;
    }
    const bool checker = has_key(reader, *value, "checker");
    if (!checker && !has_key(reader, *value, "gradient")) {
        reader.fail(*value, "this texture has no 'checker' and no 'gradient'; add one of them");
    }
    const Texture read = checker ? read_checker(reader, *value) : read_gradient(reader, *value);
    color = glm::vec3(1);
    texture = static_cast<std::uint32_t>(state.scene.textures.size());
    state.scene.textures.push_back(read);
}

std::uint32_t read_material(JsonSceneState& state, const JsonValue& value, std::string_view name) {
    const JsonReader& reader = state.reader;
    const JsonObject object(reader, value, "material", {},
                            {"model", "ambient", "diffuse", "specular", "emission", "reflection",
                             "transmission", "shininess", "ior", "ior_outside", "attenuation", "two_sided"});
    Material material;
    material.name = name;
    if (const JsonValue* model = object.find("model")) {
        constexpr std::array<std::string_view, 2> models = {"phong", "blinn"};
        material.specular_model = reader.choice(*model, "model", "models", models) == 0
                                      ? SpecularModel::phong
                                      : SpecularModel::blinn;
    }
    MaterialTextures& textures = material.textures;
    read_channel(state, object, "ambient", material.ambient, textures.ambient);
    read_channel(state, object, "diffuse", material.diffuse, textures.diffuse);
    read_channel(state, object, "specular", material.specular, textures.specular);
    read_channel(state, object, "emission", material.emission, textures.emission);
    read_channel(state, object, "reflection", material.reflection, textures.reflection);
    material.transmission = object.color("transmission", glm::dvec3(0));
    material.shininess = static_cast<float>(object.number("shininess", 1, not_negative));
    material.ior = static_cast<float>(object.number("ior", 1, positive_number));
    material.ior_outside = static_cast<float>(object.number("ior_outside", 1, positive_number));
    material.reflection_attenuation = read_attenuation(object);
    material.two_sided = object.boolean("two_sided", true);
    state.scene.materials.push_back(material);
    return static_cast<std::uint32_t>(state.scene.materials.size() - 1);
}

}  // namespace

void read_materials(JsonSceneState& state, const JsonValue& value) {
    for (const JsonMember& member : state.reader.members(value, "materials")) {
        check_name(state.reader, member, "material");
        state.materials[member.key] = read_material(state, member.value, member.key);
    }
}

std::uint32_t read_material_reference(JsonSceneState& state, const JsonValue& value) {
    if (value.kind == JsonKind::object) return read_material(state, value, "");
    if (value.kind != JsonKind::text) {
        state.reader.fail_type(value, "material", "a material's name or a material (an object)");
    }
    const std::string_view name = state.reader.text(value, "material");
    const auto found = state.materials.find(name);
    if (found == state.materials.end()) {
        state.reader.fail(value, fmt::format("there is no material {}{}", in_quotes(name),
                                             suggest(name, "materials", names_of(state.materials))));
    }
    return found->second;
}

std::uint32_t default_material(JsonSceneState& state) {
    if (const auto found = state.materials.find("default"); found != state.materials.end()) {
        return found->second;
    }
    if (!state.default_material) {
        Material material;
        material.name = "default";
        material.diffuse = glm::vec3(0.8F);
        state.default_material = static_cast<std::uint32_t>(state.scene.materials.size());
        state.scene.materials.push_back(material);
    }
    return *state.default_material;
}

glm::vec3 read_attenuation(const JsonObject& object) {
    const glm::dvec3 a = object.vector("attenuation", {1, 0, 0}, not_negative);
    if (a.x + a.y + a.z < min_length) {
        object.reader().fail(object.at("attenuation"),
                             "the attenuation is zero, and light is divided by it; 1, 0, 0 is none");
    }
    return a;
}

}  // namespace sahl
