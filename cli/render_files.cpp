#include "cli/render_files.h"

#include "cli/interruption.h"
#include "engine/film/image_io.h"

namespace sahl::cli {

namespace {

namespace fs = std::filesystem;

fs::path partial_path(const fs::path& path) {
    fs::path name = path.stem();
    name += ".partial";
    name += path.extension();
    return fs::path(path).replace_filename(name);
}

/// There is something that is no file, so that no file can be beside it.
bool is_special(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

void write_files(const Rendered& result, std::span<const Output> outputs, const Image& image,
                 std::span<const AovImage> aovs, const RenderOptions& options, const DeviceInfo& device) {
    for (const Output& output : outputs) {
        OutputSettings encoding = output.encoding;
        encoding.metadata = metadata(result, options, device);
        const bool layers = can_hold_aovs(output.path);
        write_image(output.path, image, encoding, layers ? aovs : std::span<const AovImage>());
    }
}

void save_partial(const Rendered& result, const Image& image, std::span<const AovImage> aovs,
                  const RenderOptions& options, const DeviceInfo& device) {
    const std::uint64_t finished = result.statistics.finished_pixels;
    if (finished == 0) throw Interrupted("no pixel of the image is finished, nothing of it is saved");
    std::vector<fs::path> saved;
    std::string where;
    std::string failures;
    for (const Output& output : result.outputs) {
        if (is_special(output.path)) continue;
        Rendered partial = result;
        partial.outputs = {{partial_path(output.path), output.encoding}};
        const fs::path& path = partial.outputs.front().path;
        try {
            write_files(partial, partial.outputs, image, aovs, options, device);
            where += (saved.empty() ? "saved as " : ", ") + path.string();
            saved.push_back(path);
        } catch (const Error& error) {
            failures += fmt::format("; {}", error.what());
        }
    }
    throw Interrupted(fmt::format("{} of {} pixels are finished, {}{}", finished, pixel_count(result.size),
                                  saved.empty() ? "not saved" : where, failures),
                      saved);
}

}  // namespace sahl::cli
