#include "engine/scene/scene_json.h"

#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/scene_json_groups.h"
#include "engine/scene/scene_json_lights.h"
#include "engine/scene/scene_json_materials.h"
#include "engine/scene/scene_json_objects.h"
#include "engine/scene/scene_json_state.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr int format_version = 1;

void check_version(const JsonReader& reader, const JsonObject& file) {
    const JsonValue* value = file.find("sahl");
    if (value == nullptr) {
        reader.fail(file.value(), fmt::format("this scene has no 'sahl', the version of the format; add "
                                              "\"sahl\": {}",
                                              format_version));
    }
    const double version = reader.integer(*value, "sahl");
    if (version != format_version) {
        reader.fail(*value, fmt::format("this file is of version {} of the format, this program reads "
                                        "version {}",
                                        number_text(version), format_version));
    }
}

void read_film(const JsonReader& reader, const JsonValue& value, Resolution& resolution) {
    const JsonObject film(reader, value, "film", {}, {"width", "height"});
    const auto pixels = [&](std::string_view key, int& size) {
        if (const JsonValue* found = film.find(key)) {
            size = static_cast<int>(reader.integer(*found, key, {1, max_resolution}));
        }
    };
    pixels("width", resolution.width);
    pixels("height", resolution.height);
}

void read_cameras(const JsonReader& reader, const JsonValue& value, std::vector<Camera>& cameras) {
    for (const JsonMember& member : reader.members(value, "cameras")) {
        check_name(reader, member, "camera");
        const JsonObject object(reader, member.value, "camera", {"eye", "look_at"}, {"up", "fov"});
        Camera camera;
        camera.name = member.key;
        camera.eye = object.vector("eye", {});
        camera.look_at = object.vector("look_at", {});
        camera.up = object.vector("up", camera.up);
        camera.fov_y = object.number("fov", camera.fov_y, field_of_view);
        const JsonValue* up = object.find("up");
        check_camera(camera, reader.place(object.at("look_at")),
                     up == nullptr ? object.place() : reader.place(*up));
        cameras.push_back(std::move(camera));
    }
}

// Groups may refer to each other in any order: all names first.
void read_groups(JsonSceneState& state, const JsonValue& value) {
    const std::span<const JsonMember> members = state.reader.members(value, "groups");
    for (const JsonMember& member : members) {
        check_name(state.reader, member, "group");
        state.own_groups[member.key] = static_cast<std::uint32_t>(state.groups.size());
        state.groups.emplace_back();
        state.group_names.emplace_back(member.key);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        Surroundings around;
        around.target = &state.groups[i];
        read_objects(state, members[i].value, around);
    }
}

// The world's primitives, then those of each group.
void gather_primitives(JsonSceneState& state) {
    Scene& scene = state.scene;
    scene.primitives = std::move(state.world.primitives);
    scene.instances = std::move(state.world.instances);
    for (std::size_t i = 0; i < state.groups.size(); ++i) {
        Placed& placed = state.groups[i];
        scene.groups.push_back({state.group_names[i], static_cast<std::uint32_t>(scene.primitives.size()),
                                static_cast<std::uint32_t>(placed.primitives.size()),
                                std::move(placed.instances)});
        scene.primitives.insert(scene.primitives.end(), placed.primitives.begin(), placed.primitives.end());
    }
}

}  // namespace

FileScene read_json_scene(const JsonDocument& document, const fs::path& path, SceneFiles& files,
                          const std::function<void(std::vector<Parameter>&)>& set) {
    const JsonReader plain(document, nullptr);
    const JsonObject file(plain, document.root(), "scene", {},
                          {"sahl", "$schema", "description", "parameters", "film", "depth", "background",
                           "cameras", "lights", "materials", "groups", "objects"});
    check_version(plain, file);
    for (const std::string_view key : {"$schema", "description"}) {
        const JsonValue* text = file.find(key);
        if (text != nullptr && text->kind != JsonKind::text) plain.fail_type(*text, key, "a string");
    }
    std::vector<Parameter> parameters;
    if (const JsonValue* value = file.find("parameters")) parameters = read_parameters(document, *value);
    set(parameters);

    const JsonReader reader(document, &parameters);
    JsonSceneState state(reader, path, files);
    Scene& scene = state.scene;
    scene.cameras.clear();
    if (const JsonValue* value = file.find("film")) read_film(reader, *value, scene.resolution);
    if (const JsonValue* value = file.find("depth")) {
        scene.depth = static_cast<int>(reader.integer(*value, "depth", {0, json_largest_depth}));
    }
    if (const JsonValue* value = file.find("background"))
        scene.background = reader.color(*value, "background");
    if (const JsonValue* value = file.find("cameras")) read_cameras(reader, *value, scene.cameras);
    if (const JsonValue* value = file.find("lights")) read_lights(state, *value);
    if (const JsonValue* value = file.find("materials")) read_materials(state, *value);
    if (const JsonValue* value = file.find("groups")) read_groups(state, *value);
    if (const JsonValue* value = file.find("objects")) {
        Surroundings around;
        around.target = &state.world;
        read_objects(state, *value, around);
    }
    check_parameters_used(parameters);
    check_groups(state);
    gather_primitives(state);
    scene.ambient = state.ambient.value_or(glm::vec3(1));
    return {std::move(scene), state.ambient};
}

Scene read_scene_json(const fs::path& path, std::string text, const LoadOptions& options) {
    const JsonDocument document(path.string(), std::move(text));
    const auto real = [](const fs::path& p) {
        std::error_code error;
        fs::path result = fs::weakly_canonical(fs::absolute(p), error);
        if (!result.has_filename()) result = result.parent_path();  // "folder/"
        if (error) {
            throw Error(ExitCode::scene,
                        fmt::format("cannot resolve the path {}: {}", p.string(), error.message()));
        }
        return result;
    };
    SceneFiles files;
    if (options.asset_root && !fs::is_directory(*options.asset_root)) {
        throw Error(ExitCode::usage, fmt::format("--asset-root {}: there is no such folder; check the path",
                                                 options.asset_root->string()));
    }
    files.root = real(options.asset_root.value_or(path.has_parent_path() ? path.parent_path() : "."));
    files.chain.push_back(real(path));
    FileScene file = read_json_scene(document, path, files, [&](std::vector<Parameter>& parameters) {
        set_parameters(parameters, path.string(), options.parameters);
    });
    if (file.scene.cameras.empty()) {
        throw SceneError(document.place(document.root()),
                         "the scene has no camera; add \"cameras\": {\"main\": {\"eye\": [x, y, z], "
                         "\"look_at\": [x, y, z]}}");
    }
    return std::move(file.scene);
}

}  // namespace sahl
