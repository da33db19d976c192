#include "engine/batch/manifest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "engine/batch/manifest_settings.h"
#include "engine/batch/number_ranges.h"
#include "engine/scene/scene_format.h"
#include "engine/scene/scene_json_values.h"
#include "engine/scene/text_reader.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr double largest_frame = 1e9;

std::vector<double> read_ranges(const JsonReader& reader, const JsonValue& value, std::string_view what) {
    const std::string_view text = reader.text(value, what);
    const auto numbers = parse_ranges(text);
    if (!numbers) {
        reader.fail(value,
                    fmt::format("{} is no list of numbers and ranges of at most a million; write it as "
                                "\"1-100x2,150\" (1 to 100 in steps of 2, and 150)",
                                in_quotes(text)));
    }
    return *numbers;
}

std::vector<int> read_frames(const JsonReader& reader, const JsonValue& value) {
    if (value.kind == JsonKind::number)
        return {static_cast<int>(reader.integer(value, "frames", {-largest_frame, largest_frame}))};
    std::vector<int> frames;
    std::set<int> seen;
    for (const double number : read_ranges(reader, value, "frames")) {
        if (std::floor(number) != number || std::abs(number) > largest_frame)
            reader.fail(value, fmt::format("the frame {} is no whole number within a billion", number));
        const int frame = static_cast<int>(number);
        if (!seen.insert(frame).second)
            reader.fail(value, fmt::format("the frame {} is there twice; write each once", frame));
        frames.push_back(frame);
    }
    return frames;
}

glm::dvec3 read_key_value(const JsonReader& reader, const JsonValue& value, bool is_vector) {
    if (is_vector) return reader.vector(value, "value");
    return {reader.number(value, "value"), 0, 0};
}

KeyFrames read_keys(const JsonReader& reader, const JsonValue& value) {
    const JsonObject object(reader, value, "key-framed value", {"keys"}, {"interpolation"});
    KeyFrames keys;
    constexpr std::string_view names[] = {"linear", "smooth"};
    if (const JsonValue* how = object.find("interpolation")) {
        keys.interpolation =
            static_cast<Interpolation>(reader.choice(*how, "interpolation", "interpolations", names));
    }
    constexpr std::string_view form = "an array of keys ([frame, value])";
    const std::span<const JsonValue> list = reader.array(object.at("keys"), "keys", form);
    if (list.empty()) reader.fail(object.at("keys"), "there is no key; give at least one ([frame, value])");
    for (const JsonValue& key : list) {
        if (key.kind != JsonKind::array || key.count != 2)
            reader.fail_type(key, "keys", "a frame and a value ([frame, value])");
        const std::span<const JsonValue> pair = reader.document().elements(key);
        if (keys.frames.empty()) keys.is_vector = pair[1].kind == JsonKind::array;
        const double frame = reader.number(pair[0], "frame", {-largest_frame, largest_frame});
        if (!keys.frames.empty() && frame <= keys.frames.back()) {
            reader.fail(pair[0],
                        fmt::format("the frame {} is not behind the key before, {}; order the keys by "
                                    "frame",
                                    frame, keys.frames.back()));
        }
        keys.frames.push_back(frame);
        keys.values.push_back(read_key_value(reader, pair[1], keys.is_vector));
    }
    return keys;
}

/// A plain value as `--set` takes it.
std::string value_text(const JsonReader& reader, const JsonValue& value) {
    switch (value.kind) {
        case JsonKind::number:
            return decimal(reader.number(value, "value"));
        case JsonKind::boolean:
            return value.number != 0 ? "true" : "false";
        case JsonKind::text:
            return std::string(reader.text(value, "value"));
        case JsonKind::array:
            if (value.count == 3) return decimals(reader.vector(value, "value"), ",");
            break;
        case JsonKind::object:
        case JsonKind::null:
            break;
    }
    reader.fail_type(value, "value",
                     "a number, a text, true, false or a vector ([x, y, z]); several values are "
                     "{\"values\": [...]}");
}

BatchParameter read_parameter(const JsonReader& reader, const JsonMember& member) {
    BatchParameter parameter{std::string(member.key), {}, reader.document().place(member)};
    if (member.value.kind != JsonKind::object) {
        parameter.values = std::vector{value_text(reader, member.value)};
        return parameter;
    }
    const JsonObject object(reader, member.value, "parameter", {},
                            {"values", "range", "keys", "interpolation"});
    if (object.find("keys") != nullptr) {
        parameter.values = read_keys(reader, member.value);
        return parameter;
    }
    std::vector<std::string> texts;
    if (const JsonValue* values = object.find("values")) {
        if (object.find("range") != nullptr)
            reader.fail(member.value, "'values' and 'range' are both there; keep one of them");
        for (const JsonValue& value : reader.array(*values, "values", "an array of values"))
            texts.push_back(value_text(reader, value));
    } else if (const JsonValue* range = object.find("range")) {
        for (const double number : read_ranges(reader, *range, "range")) texts.push_back(decimal(number));
    }
    if (texts.empty())
        reader.fail(member.value, "this parameter has no value; give it 'values', a 'range' or 'keys'");
    parameter.values = std::move(texts);
    return parameter;
}

/// A value of a camera, fixed or key-framed.
KeyFrames read_path(const JsonReader& reader, const JsonValue& value, std::string_view what, bool is_vector) {
    KeyFrames keys;
    if (value.kind == JsonKind::object) {
        keys = read_keys(reader, value);
        if (keys.is_vector != is_vector)
            reader.fail(value, fmt::format("{}: the keys' values are {}", in_quotes(what),
                                           is_vector ? "vectors ([x, y, z])" : "numbers"));
        return keys;
    }
    keys.is_vector = is_vector;
    keys.frames = {0};
    keys.values = {is_vector ? reader.vector(value, what) : glm::dvec3(reader.number(value, what), 0, 0)};
    return keys;
}

BatchCamera read_camera(const JsonReader& reader, const JsonValue& value) {
    if (value.kind == JsonKind::text)
        return {std::string(reader.text(value, "camera")), {}, reader.place(value)};
    const JsonObject object(reader, value, "camera", {"name", "eye", "look_at"}, {"up", "fov", "turn"});
    const Camera usual;
    const auto path = [&](std::string_view key, bool is_vector, glm::dvec3 otherwise) {
        const JsonValue* found = object.find(key);
        if (found != nullptr) return read_path(reader, *found, key, is_vector);
        return KeyFrames{is_vector, Interpolation::linear, {0}, {otherwise}};
    };
    return {std::string(reader.text(object.at("name"), "name")),
            CameraPath{path("eye", true, {}), path("look_at", true, {}), path("up", true, usual.up),
                       path("fov", false, glm::dvec3(usual.fov_y, 0, 0)), path("turn", false, {})},
            reader.place(value)};
}

/// A text, or an array of texts.
template <class Take>
void read_texts(const JsonReader& reader, const JsonValue& value, std::string_view what, Take take) {
    if (value.kind == JsonKind::text) return take(value);
    const std::span<const JsonValue> list = reader.array(value, what, "a string or an array of strings");
    if (list.empty()) reader.fail(value, fmt::format("'{}' is empty; name at least one", what));
    for (const JsonValue& element : list) take(element);
}

std::vector<std::string> read_outputs(const JsonReader& reader, const JsonValue& value,
                                      const fs::path& folder) {
    std::vector<std::string> outputs;
    read_texts(reader, value, "outputs", [&](const JsonValue& output) {
        outputs.push_back((folder / reader.text(output, "outputs")).string());
    });
    return outputs;
}

void read_zips(const JsonReader& reader, const JsonValue& value, BatchEntry& entry) {
    std::set<std::string_view> zipped;
    for (const JsonValue& list : reader.array(value, "zip", "an array of arrays of parameter names")) {
        std::vector<std::string> names;
        std::size_t count = 0;
        for (const JsonValue& element : reader.array(list, "zip", "an array of parameter names")) {
            const std::string_view name = reader.text(element, "zip");
            std::vector<std::string_view> known;
            const BatchParameter* found = nullptr;
            for (const BatchParameter& parameter : entry.parameters) {
                known.push_back(parameter.name);
                if (parameter.name == name) found = &parameter;
            }
            if (found == nullptr) {
                reader.fail(element, fmt::format("there is no parameter {} here{}", in_quotes(name),
                                                 suggest(name, "parameters of this job", known)));
            }
            if (!zipped.insert(found->name).second)
                reader.fail(element, fmt::format("{} is zipped already; name it once", in_quotes(name)));
            const auto* values = std::get_if<std::vector<std::string>>(&found->values);
            if (values == nullptr) {
                reader.fail(element,
                            fmt::format("{} has keys: it follows the frames; leave it out of the zip",
                                        in_quotes(name)));
            }
            if (!names.empty() && values->size() != count) {
                reader.fail(element,
                            fmt::format("{} has {} values and {} has {}; what is zipped has as many",
                                        in_quotes(name), values->size(), in_quotes(names.front()), count));
            }
            count = values->size();
            names.push_back(found->name);
        }
        entry.zips.push_back(std::move(names));
    }
}

bool follows_frames(const BatchEntry& entry) {
    const auto moves = [](const KeyFrames& keys) { return keys.frames.size() > 1; };
    const auto camera_moves = [&](const BatchCamera& camera) {
        const auto& path = camera.path;
        return path && (moves(path->eye) || moves(path->look_at) || moves(path->up) || moves(path->fov) ||
                        moves(path->turn));
    };
    const auto has_keys = [](const BatchParameter& p) { return std::holds_alternative<KeyFrames>(p.values); };
    return std::any_of(entry.cameras.begin(), entry.cameras.end(), camera_moves) ||
           std::any_of(entry.parameters.begin(), entry.parameters.end(), has_keys);
}

BatchEntry read_entry(const JsonReader& reader, const JsonValue& value, const BatchEntry& common,
                      const fs::path& folder) {
    const JsonObject object(reader, value, "job", {"scene"},
                            {"description", "cameras", "frames", "parameters", "zip", "settings", "outputs"});
    BatchEntry entry = common;
    entry.place = reader.place(value);
    read_texts(reader, object.at("scene"), "scene", [&](const JsonValue& scene) {
        const fs::path path = folder / reader.text(scene, "scene");
        if (!scene_format(path)) reader.fail(scene, unknown_scene_format(path));
        entry.scenes.push_back(path);
    });
    if (const JsonValue* list = object.find("cameras")) {
        constexpr std::string_view form = "an array of cameras: names of the scene's, or descriptions";
        for (const JsonValue& camera : reader.array(*list, "cameras", form)) {
            entry.cameras.push_back(read_camera(reader, camera));
            const auto same = [&](const BatchCamera& c) { return c.name == entry.cameras.back().name; };
            if (std::count_if(entry.cameras.begin(), entry.cameras.end(), same) > 1)
                reader.fail(camera, fmt::format("the camera {} is there twice",
                                                in_quotes(entry.cameras.back().name)));
        }
    }
    if (const JsonValue* frames = object.find("frames")) entry.frames = read_frames(reader, *frames);
    if (const JsonValue* list = object.find("parameters")) {
        for (const JsonMember& member : reader.members(*list, "parameters"))
            entry.parameters.push_back(read_parameter(reader, member));
    }
    if (const JsonValue* zip = object.find("zip")) read_zips(reader, *zip, entry);
    if (const JsonValue* settings = object.find("settings"))
        entry.settings = overlay(entry.settings, read_image_settings(reader, *settings));
    if (const JsonValue* outputs = object.find("outputs"))
        entry.outputs = read_outputs(reader, *outputs, folder);
    if (entry.outputs.empty()) {
        reader.fail(value,
                    "this job has no 'outputs', and the manifest has none for all; add \"outputs\": "
                    "\"{scene}.png\"");
    }
    if (entry.frames.empty() && follows_frames(entry))
        reader.fail(value, "keys follow the frames, and this job has none; add \"frames\": \"1-100\"");
    return entry;
}

}  // namespace

bool is_manifest(const fs::path& path) {
    if (scene_format(path) != SceneFormat::json) return false;
    const JsonDocument document(path.string(), read_scene_file(path));
    if (document.root().kind != JsonKind::object) return false;
    const std::span<const JsonMember> members = document.members(document.root());
    return std::any_of(members.begin(), members.end(), [](const JsonMember& m) { return m.key == "jobs"; });
}

std::vector<BatchEntry> read_manifest(const fs::path& path) {
    const JsonDocument document(path.string(), read_scene_file(path));
    const JsonReader reader(document, nullptr);
    const JsonObject file(reader, document.root(), "manifest", {"jobs"},
                          {"$schema", "description", "asset_root", "settings", "outputs"});
    const fs::path folder = path.parent_path();
    BatchEntry common;
    if (const JsonValue* root = file.find("asset_root"))
        common.asset_root = folder / reader.text(*root, "asset_root");
    if (const JsonValue* settings = file.find("settings"))
        common.settings = read_image_settings(reader, *settings);
    if (const JsonValue* outputs = file.find("outputs"))
        common.outputs = read_outputs(reader, *outputs, folder);
    std::vector<BatchEntry> entries;
    for (const JsonValue& job : reader.array(file.at("jobs"), "jobs", "an array of jobs"))
        entries.push_back(read_entry(reader, job, common, folder));
    if (entries.empty()) reader.fail(file.at("jobs"), "there is no job; add {\"scene\": \"scene.json\"}");
    return entries;
}

}  // namespace sahl
