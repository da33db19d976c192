#include "engine/scene/load.h"

#include <algorithm>
#include <string>

#include "engine/core/error.h"
#include "engine/scene/scene_cse167.h"
#include "engine/scene/scene_nff.h"
#include "engine/scene/text_reader.h"

namespace sahl {

Scene load_scene(const std::filesystem::path& path, const LoadOptions&) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const bool nff = extension == ".nff";
    if (!nff && extension != ".test") {
        throw Error(ExitCode::usage, path.string() + ": no scene format has the extension '" + extension +
                                         "'; formats are .nff (Neutral File Format) and .test (CSE 167)");
    }
    TextReader reader = TextReader::from_file(path);
    return nff ? read_nff(reader) : read_cse167(reader);
}

}  // namespace sahl
