#include "engine/scene/load.h"

#include "engine/core/error.h"
#include "engine/core/host_steps.h"
#include "engine/scene/scene_cse167.h"
#include "engine/scene/scene_format.h"
#include "engine/scene/scene_json.h"
#include "engine/scene/scene_nff.h"
#include "engine/scene/text_reader.h"

namespace sahl {

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
    const HostStep step("load scene");
    const std::optional<SceneFormat> format = scene_format(path);
    if (!format) throw Error(ExitCode::usage, path.string() + ": " + unknown_scene_format(path));
    if (*format == SceneFormat::json) return read_scene_json(path, read_scene_file(path), options);
    if (!options.parameters.empty()) {
        const auto& [name, value] = options.parameters.front();
        throw Error(ExitCode::usage, "--set " + name + "=" + value + ": " + path.string() +
                                         " has no parameters; only Sahl scenes (.json) have them");
    }
    TextReader reader = TextReader::from_file(path);
    return *format == SceneFormat::nff ? read_nff(reader) : read_cse167(reader);
}

}  // namespace sahl
