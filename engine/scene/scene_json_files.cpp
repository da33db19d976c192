#include "engine/scene/scene_json_files.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

// RFC 3986, section 3.1.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find_first_of(":/");
    if (colon == std::string_view::npos || uri[colon] != ':' || colon == 0) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '+' ||
               c == '-' || c == '.';
    });
}

bool lies_in(const fs::path& file, const fs::path& folder) {
    const auto [in_folder, in_file] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return in_folder == folder.end();
}

}  // namespace

SceneFile find_scene_file(const JsonSceneState& state, const JsonValue& value, std::string_view uri) {
    const JsonReader& reader = state.reader;
    if (uri.empty()) reader.fail(value, "the uri is empty; name a file");
    if (std::any_of(uri.begin(), uri.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; })) {
        reader.fail(value, "the uri holds a control character; remove it");
    }
    if (uri.front() == '/' || has_scheme(uri)) {
        reader.fail(value, fmt::format("{} is no relative path; name a file by its path from this file's "
                                       "folder, without a scheme such as http:",
                                       in_quotes(uri)));
    }
    SceneFile file;
    const fs::path written = state.path.parent_path() / uri;
    file.shown = written.lexically_normal();
    std::error_code error;
    // weakly_canonical() leaves a relative path to nothing relative.
    const auto real = [&](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path), error); };
    file.real = real(written);
    // Behind a link to a folder, `..` leads elsewhere.
    if (!error && real(file.shown) != file.real) file.shown = written;
    if (error) reader.fail(value, fmt::format("cannot read {}: {}", file.shown.string(), error.message()));
    if (!lies_in(file.real, state.files.root)) {
        reader.fail(value, fmt::format("{} lies outside the asset root {}; move the file into it, or name a "
                                       "wider folder with --asset-root",
                                       file.shown.string(), state.files.root.string()));
    }
    const fs::file_status status = fs::status(file.real, error);
    if (status.type() == fs::file_type::not_found) {
        reader.fail(value, fmt::format("there is no file {}; check the uri", file.shown.string()));
    }
    if (!fs::is_regular_file(status)) {
        reader.fail(value, fmt::format("{} is no regular file; name a scene file", file.shown.string()));
    }
    return file;
}

}  // namespace sahl
