#include "engine/film/image_decode.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <new>

#include "engine/core/error.h"
#include "engine/device/memory.h"
#include "engine/film/image_codecs.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

/// Values that one byte of a file may stand for. The tightest of the usual compressions, deflate over
/// 8x8 blocks, comes to 66,000; a few hundred bytes that claim to be gigabytes are an attack.
constexpr std::uintmax_t max_values_per_byte = 100'000;

/// Size and layout are such as read_image takes.
void check_header(const fs::path& path, const StoredImage& stored) {
    if (!stored.is_flat || stored.channels.empty()) fail_decoding(path, "it holds no flat image");
    const std::string size = std::to_string(stored.width) + "x" + std::to_string(stored.height);
    const auto is_size = [](int length) { return length >= 1 && length <= max_image_size; };
    if (!is_size(stored.width) || !is_size(stored.height))
        fail_decoding(path, "it claims a size of " + size + ", where at most 65536x65536 is allowed");
    const std::uintmax_t bytes = fs::file_size(path);
    const std::uintmax_t values = static_cast<std::uintmax_t>(stored.width) *
                                  static_cast<std::uintmax_t>(stored.height) * stored.channels.size();
    if (values / max_values_per_byte > bytes)
        fail_decoding(path, "it claims " + size + " pixels in " + std::to_string(bytes) + " bytes");
}

}  // namespace

void fail_decoding(const fs::path& path, std::string cause) {
    while (!cause.empty() && std::isspace(static_cast<unsigned char>(cause.back()))) cause.pop_back();
    throw Error(ExitCode::scene, "cannot read image '" + path.string() + "': " + cause +
                                     "; give an image file such as EXR, PNG, JPEG, HDR or TIFF");
}

void fail_for_memory(const fs::path& path) {
    throw Error(ExitCode::memory,
                "image '" + path.string() + "' does not fit into memory; use a smaller image");
}

Image decode(const fs::path& path, const std::function<void(std::size_t)>& before_pixels) try {
    std::error_code cause;
    const fs::file_status status = fs::status(path, cause);
    if (!fs::exists(status)) fail_decoding(path, cause.message());
    if (fs::is_directory(status)) fail_decoding(path, "it is a folder");
    // Decoders go back and forth in a file; a FIFO would block them for ever.
    if (!fs::is_regular_file(status)) fail_decoding(path, "it is no regular file");

    std::string error;
    const auto decoder = image_codecs(ExitCode::scene).decode(path.string(), error);
    if (!decoder) fail_decoding(path, error);
    const StoredImage& stored = decoder->image();
    check_header(path, stored);

    const auto red = std::find(stored.channels.begin(), stored.channels.end(), "R");
    const bool named = stored.channels.end() - red >= 3 && red[1] == "G" && red[2] == "B";
    const int first = named ? static_cast<int>(red - stored.channels.begin()) : 0;
    const int count = stored.channels.size() < 3 ? 1 : 3;
    const std::size_t values =
        3 * static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height);
    if (values * sizeof(float) > physical_memory_bytes()) throw std::bad_alloc();
    before_pixels(values);
    Image image{
        .width = stored.width, .height = stored.height, .channels = 3, .pixels = std::vector<float>(values)};
    if (!decoder->read(first, count, image.pixels.data())) fail_decoding(path, decoder->error());
    if (count == 1)
        for (std::size_t i = 0; i < values; i += 3)
            image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];

    // OpenImageIO multiplies codes by the rounded 1/max; this is their nearest quotient.
    const float max = stored.largest_code;
    if (max > 0)
        for (float& value : image.pixels) value = std::round(value * max) / max;
    return image;
} catch (const std::bad_alloc&) {
    fail_for_memory(path);
}

}  // namespace sahl
