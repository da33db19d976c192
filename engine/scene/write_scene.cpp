#include "engine/scene/write_scene.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/scene/write_cse167.h"
#include "engine/scene/write_json.h"
#include "engine/scene/write_nff.h"

namespace sahl {
namespace {

struct Format {
    std::string_view extension;
    std::string (*write)(const Scene&);
};

constexpr std::array<Format, 3> formats = {{
    {".json", write_json},
    {".nff", write_nff},
    {".test", write_cse167},
}};

const Format& format_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    for (const Format& format : formats) {
        if (format.extension == extension) return format;
    }
    throw Error(
        ExitCode::usage,
        fmt::format("{}: no scene is written with the extension '{}'; formats are .json (Sahl scene), "
                    ".nff (Neutral File Format) and .test (CSE 167)",
                    path.string(), extension));
}

}  // namespace

void check_scene_output(const std::filesystem::path& path) {
    format_of(path);
    check_output_file(path);
}

void write_scene(const std::filesystem::path& path, const Scene& scene) {
    const std::string text = format_of(path).write(scene);
    write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace sahl
