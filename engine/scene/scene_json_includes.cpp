#include "engine/scene/scene_json_includes.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/scene_cse167.h"
#include "engine/scene/scene_format.h"
#include "engine/scene/scene_json_files.h"
#include "engine/scene/scene_json_materials.h"
#include "engine/scene/scene_merge.h"
#include "engine/scene/scene_nff.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t deepest_include = 16;
constexpr int most_includes = 10000;  // files that include each other several times multiply

std::string chain_text(const SceneFiles& files, const fs::path& last) {
    std::string text;
    for (const fs::path& path : files.chain) {
        if (path == last || !text.empty()) text += path.filename().string() + " -> ";
    }
    return text + last.filename().string();
}

// Tells of an error inside an included file from where it was included.
template <typename Read>
FileScene read_inside(const SourceLocation& here, const Read& read) {
    try {
        return read();
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("{} (included from {}:{}:{})", error.what(), here.file,
                                              here.line, here.column));
    }
}

FileScene read_file(JsonSceneState& state, const JsonObject& object, const SceneFile& file,
                    const JsonValue& uri) {
    const JsonReader& reader = state.reader;
    const std::string name = file.shown.string();
    const std::optional<SceneFormat> format = scene_format(file.shown);
    if (!format) reader.fail(uri, fmt::format("{}: {}", name, unknown_scene_format(file.shown)));
    std::string text;
    try {
        text = read_scene_file(file.real);
    } catch (const Error& error) {
        reader.fail(uri, error.what());
    }
    const SourceLocation here = reader.place(uri);
    const JsonValue* set = object.find("set");
    if (*format != SceneFormat::json) {
        if (set != nullptr) reader.fail(*set, fmt::format("{} has no parameters; remove 'set'", name));
        return read_inside(here, [&]() -> FileScene {
            TextReader words(name, std::move(text));
            return {*format == SceneFormat::nff ? read_nff(words) : read_cse167(words), std::nullopt};
        });
    }
    std::exception_ptr wrong_set;  // an error of this file, not of the included one
    const auto set_all = [&](std::vector<Parameter>& parameters) {
        if (set == nullptr) return;
        try {
            set_parameters(parameters, name, reader, *set);
        } catch (const Error&) {
            wrong_set = std::current_exception();
            throw;
        }
    };
    try {
        return read_inside(here, [&] {
            const JsonDocument document(name, std::move(text));
            return read_json_scene(document, file.shown, state.files, set_all);
        });
    } catch (const Error&) {
        if (wrong_set) std::rethrow_exception(wrong_set);
        throw;
    }
}

// Which of the outer materials take the place of the file's own.
std::vector<std::uint32_t> replace_materials(JsonSceneState& state, const JsonObject& object,
                                             const Surroundings& around, const Scene& scene) {
    if (around.material) return std::vector<std::uint32_t>(scene.materials.size(), *around.material);
    std::vector<std::uint32_t> replaced(scene.materials.size(), MergePlan::keep);
    const JsonValue* materials = object.find("materials");
    if (materials == nullptr) return replaced;
    for (const JsonMember& member : state.reader.members(*materials, "materials")) {
        const std::uint32_t material = read_material_reference(state, member.value);
        bool found = false;
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            if (scene.materials[i].name != member.key) continue;
            replaced[i] = material;
            found = true;
        }
        if (found) continue;
        std::vector<std::string_view> names;
        for (const Material& m : scene.materials) {
            if (!m.name.empty()) names.push_back(m.name);
        }
        throw SceneError(state.reader.document().place(member),
                         fmt::format("the included scene has no material {}{}", in_quotes(member.key),
                                     suggest(member.key, "its materials", names)));
    }
    return replaced;
}

void take_lights(JsonSceneState& state, const FileScene& file, const glm::dmat4& m,
                 const SourceLocation& where) {
    const auto point = [&](glm::dvec3 p) {
        const glm::dvec3 placed(m * glm::dvec4(p, 1));
        for (int axis = 0; axis < 3; ++axis)
            check_range(placed[axis], any_number, "the place of an included light", where);
        return placed;
    };
    const auto direction = [&](glm::dvec3 d) { return glm::normalize(glm::dmat3(m) * glm::normalize(d)); };
    const bool moves = m != glm::dmat4(1);
    for (Light light : file.scene.lights) {
        if (moves && light.kind == LightKind::directional) {
            light.position = direction(light.position);
        } else if (moves) {
            light.position = point(light.position);
            if (light.kind == LightKind::spot) light.direction = direction(light.direction);
        }
        state.scene.lights.push_back(light);
    }
    if (file.ambient) state.ambient = state.ambient.value_or(glm::vec3(0)) + *file.ambient;
}

void take_cameras(JsonSceneState& state, const Scene& scene, const glm::dmat4& m,
                  const SourceLocation& where) {
    for (Camera camera : scene.cameras) {
        const auto& own = state.scene.cameras;
        if (std::any_of(own.begin(), own.end(), [&](const Camera& c) { return c.name == camera.name; })) {
            throw SceneError(where,
                             fmt::format("there is a camera {} already, and the included scene has one; "
                                         "rename one of them or leave its cameras out",
                                         in_quotes(camera.name)));
        }
        if (m != glm::dmat4(1)) {
            camera.eye = glm::dvec3(m * glm::dvec4(camera.eye, 1));
            camera.look_at = glm::dvec3(m * glm::dvec4(camera.look_at, 1));
            camera.up = glm::dmat3(m) * camera.up;
            for (int axis = 0; axis < 3; ++axis) {
                for (const double x : {camera.eye[axis], camera.look_at[axis], camera.up[axis]})
                    check_range(x, any_number, "the place of an included camera", where);
            }
            check_camera(camera, where, where);
        }
        state.scene.cameras.push_back(camera);
    }
}

}  // namespace

void read_include(JsonSceneState& state, const JsonObject& object, const Surroundings& around) {
    const JsonReader& reader = state.reader;
    SceneFiles& files = state.files;
    const JsonValue& uri = object.at("uri");
    const bool with_lights = object.boolean("lights", false);
    const bool with_cameras = object.boolean("cameras", false);
    if (around.material && object.find("materials") != nullptr) {
        reader.fail(*object.find("materials"),
                    "'material' already replaces all materials; remove one of them");
    }
    const SceneFile file = find_scene_file(state, uri, reader.text(uri, "uri"));
    if (std::find(files.chain.begin(), files.chain.end(), file.real) != files.chain.end()) {
        reader.fail(uri, fmt::format("{} includes itself: {}", file.shown.filename().string(),
                                     chain_text(files, file.real)));
    }
    if (files.chain.size() > deepest_include) {
        reader.fail(uri, fmt::format("includes nest deeper than {}; nest them less", deepest_include));
    }
    if (++files.read > most_includes) {
        reader.fail(uri,
                    fmt::format("more than {} files are included; use instances of a group", most_includes));
    }

    files.chain.push_back(file.real);
    const FileScene included = read_file(state, object, file, uri);
    files.chain.pop_back();

    MergePlan plan;
    plan.materials = replace_materials(state, object, around, included.scene);
    plan.value = &object.value();
    if (object.find("sides") != nullptr) plan.sides = around.sides;
    merge_scene(state, included.scene, plan, around);
    if (with_lights) take_lights(state, included, around.transform, reader.place(object.at("lights")));
    if (with_cameras) {
        take_cameras(state, included.scene, around.transform, reader.place(object.at("cameras")));
    }
}

}  // namespace sahl
