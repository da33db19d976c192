// A batch in a folder of its own, for tests of `sahl batch`.
#pragma once

#include <sys/stat.h>

#include <map>
#include <string>
#include <vector>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {

/// What tells that a file is the very same one: a file that was written again has another inode or time.
struct FileIdentity {
    ino_t inode = 0;
    long seconds = 0;
    long nanoseconds = 0;
    bool operator==(const FileIdentity&) const = default;
};

inline FileIdentity identity_of(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

/// A scene with a ball that moves along x with the parameter of that name, and a manifest of its frames.
struct Night {
    TemporaryFolder folder;
    ProcessOptions options{};

    explicit Night(const std::string& frames, const std::string& outputs = "\"out/{frame:04}.exr\"",
                   const std::string& settings = "{}") {
        write_scene("[0.8, 0.2, 0.1]");
        write_manifest(frames, outputs, settings);
        options.working_directory = folder.path();
    }

    void write_scene(const std::string& red) const {
        write_file(folder / "balls.json", R"({
  "sahl": 1,
  "film": {"width": 24, "height": 16},
  "parameters": {"x": {"type": "number", "default": 0}},
  "cameras": {"main": {"eye": [0, 1, 6], "look_at": [0, 0, 0]}, "top": {"eye": [0, 6, 1], "look_at": [0, 0, 0]}},
  "lights": [{"type": "point", "position": [3, 5, 4]}],
  "materials": {"red": {"diffuse": )" + red + R"(}, "mirror": {"diffuse": 0.1, "reflection": 0.8}},
  "objects": [{"type": "sphere", "center": ["$x", 0, 0], "material": "red"},
              {"type": "sphere", "center": [0, -101, 0], "radius": 100, "material": "mirror"}]
})");
    }

    void write_manifest(const std::string& frames, const std::string& outputs,
                        const std::string& settings) const {
        write_file(folder / "night.json", R"({"settings": )" + settings + R"(, "outputs": )" + outputs +
                                              R"(, "jobs": [{"scene": "balls.json", "frames": ")" + frames +
                                              R"(", "parameters": {"x": {"keys": [[1, -2], [100, 2]]}}}]})");
    }

    std::vector<std::string> command(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"batch", "night.json", "--json"});
        return sahl_command(more);
    }
    ProcessResult run(std::vector<std::string> more = {}) const {
        return run_process(command(std::move(more)), options);
    }

    /// Images and whatever else lies beside them, without what a batch keeps for itself.
    std::map<std::string, FileIdentity> files() const {
        std::map<std::string, FileIdentity> found;
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "out", none))
            if (!entry.path().filename().string().starts_with(".sahl-batch"))
                found[entry.path().filename().string()] = identity_of(entry.path());
        return found;
    }
};

/// The events of that name.
inline std::vector<nlohmann::json> events(const ProcessResult& result, const std::string& name) {
    std::vector<nlohmann::json> found;
    for (const nlohmann::json& event : json_lines(result.out))
        if (event.at("event") == name) found.push_back(event);
    return found;
}

}  // namespace sahl::tests
