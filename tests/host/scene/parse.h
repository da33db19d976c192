// Scenes out of strings and of the tests' own files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/scene/scene.h"
#include "engine/scene/scene_cse167.h"
#include "engine/scene/scene_json.h"
#include "engine/scene/scene_nff.h"

namespace sahl::tests {

inline Scene parse_nff(const std::string& text) {
    TextReader reader("scene.nff", text);
    return read_nff(reader);
}

inline Scene parse_cse167(const std::string& text) {
    TextReader reader("scene.test", text);
    return read_cse167(reader);
}

/// What is in front of the objects of parse_json: one line.
inline const std::string json_head =
    R"({"sahl": 1, "cameras": {"main": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}, "objects": [)"
    "\n";

/// A Sahl scene of these objects, which begin on line 2.
inline Scene parse_json(const std::string& objects, const LoadOptions& options = {}) {
    return read_scene_json("scene.json", json_head + objects + "]}", options);
}

/// A file of tests/data.
inline std::filesystem::path own_scene(const std::string& name) {
    return std::filesystem::path(std::getenv("SAHL_SOURCE_DIR")) / "tests" / "data" / name;
}

/// The least complete view: six lines.
inline const std::string nff_view =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 48\n";

/// The least complete CSE 167 scene: two lines.
inline const std::string cse167_head = "size 64 48\ncamera 0 0 5 0 0 0 0 1 0 45\n";

}  // namespace sahl::tests
