// What grows while a Sahl scene is read: one state for each file.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/scene/scene.h"
#include "engine/scene/scene_json_values.h"

namespace sahl {

/// The files that one load reads.
struct SceneFiles {
    std::filesystem::path root;                ///< without symbolic links; files lie in it
    std::vector<std::filesystem::path> chain;  ///< the open ones, the outermost first, without links
    int read = 0;                              ///< includes so far
};

/// What is placed together, in the world or in a group.
struct Placed {
    std::vector<Primitive> primitives;
    std::vector<Instance> instances;
    std::vector<const JsonValue*> instance_values;  ///< what in the file made each of the instances
};

/// A scene that a file describes, for the file that includes it.
struct FileScene {
    Scene scene;                       ///< without any camera if the file has none
    std::optional<glm::vec3> ambient;  ///< the sum of the ambient lights, if there is one
};

struct JsonSceneState {
    // A constructor, and no braces behind the members: where an aggregate's initialization runs out of
    // memory GCC 12 destroys the members of a member twice.
    JsonSceneState(const JsonReader& with, std::filesystem::path from, SceneFiles& among)
        : reader(with), path(std::move(from)), files(among) {}

    const JsonReader& reader;
    std::filesystem::path path;  ///< of this file
    SceneFiles& files;

    Scene scene;  ///< its primitives, instances and groups are below until the end
    Placed world;
    std::deque<Placed> groups;  ///< this file's own, then those of its includes
    std::vector<std::string> group_names;
    std::map<std::string_view, std::uint32_t> own_groups;
    std::map<std::string_view, std::uint32_t> materials;  ///< by name
    std::optional<std::uint32_t> default_material;
    std::optional<glm::vec3> ambient;
};

/// What an object has from the group object around it.
struct Surroundings {
    Placed* target = nullptr;
    glm::dmat4 transform{1};
    std::optional<std::uint32_t> material{};
    Sides sides = Sides::both;
};

/// The index of a transformation in the scene; the one before is shared.
std::uint32_t add_transform(Scene& scene, const glm::dmat4& m);

/// The names of a map, in its order.
template <typename Value>
std::vector<std::string_view> names_of(const std::map<std::string_view, Value>& map) {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : map) names.push_back(name);
    return names;
}

/// Reads a document whose path is the last in the chain of `files`. `set` gets the declared
/// parameters to change.
FileScene read_json_scene(const JsonDocument& document, const std::filesystem::path& path, SceneFiles& files,
                          const std::function<void(std::vector<Parameter>&)>& set);

}  // namespace sahl
