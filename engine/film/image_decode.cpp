#include "engine/film/image_decode.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <new>

#include "engine/core/error.h"
#include "engine/device/memory.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

/// Values that one byte of a file may stand for. The tightest of the usual compressions, deflate over
/// 8x8 blocks, comes to 66,000; a few hundred bytes that claim to be gigabytes are an attack.
constexpr std::uintmax_t max_values_per_byte = 100'000;

/// Size and layout are such as read_image takes.
void check_header(const fs::path& path, const OIIO::ImageSpec& spec) {
    if (spec.deep || spec.depth > 1 || spec.nchannels < 1) fail_decoding(path, "it holds no flat image");
    const std::string size = std::to_string(spec.width) + "x" + std::to_string(spec.height);
    if (spec.width < 1 || spec.height < 1 || spec.width > max_image_size || spec.height > max_image_size)
        fail_decoding(path, "it claims a size of " + size + ", where at most 65536x65536 is allowed");
    const std::uintmax_t bytes = fs::file_size(path);
    if (spec.image_pixels() * static_cast<std::uintmax_t>(spec.nchannels) / max_values_per_byte > bytes)
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

    OIIO::ImageSpec as_stored;  // or colours come multiplied by alpha
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path.string(), &as_stored);
    if (!input) fail_decoding(path, OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    check_header(path, spec);

    const auto red = std::find(spec.channelnames.begin(), spec.channelnames.end(), "R");
    const bool named = spec.channelnames.end() - red >= 3 && red[1] == "G" && red[2] == "B";
    const int first = named ? static_cast<int>(red - spec.channelnames.begin()) : 0;
    const int stored = spec.nchannels < 3 ? 1 : 3;
    const std::size_t values =
        3 * static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    if (values * sizeof(float) > physical_memory_bytes()) throw std::bad_alloc();
    before_pixels(values);
    Image image{
        .width = spec.width, .height = spec.height, .channels = 3, .pixels = std::vector<float>(values)};
    constexpr OIIO::stride_t pixel = 3 * sizeof(float);
    if (!input->read_image(0, 0, first, first + stored, OIIO::TypeDesc::FLOAT, image.pixels.data(), pixel))
        fail_decoding(path, input->geterror());
    if (stored == 1)
        for (std::size_t i = 0; i < values; i += 3)
            image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];

    // OpenImageIO multiplies codes by the rounded 1/max; this is their nearest quotient.
    const float max = spec.format == OIIO::TypeDesc::UINT8    ? 255.0F
                      : spec.format == OIIO::TypeDesc::UINT16 ? 65535.0F
                                                              : 0.0F;
    if (max > 0)
        for (float& value : image.pixels) value = std::round(value * max) / max;
    return image;
} catch (const std::bad_alloc&) {
    fail_for_memory(path);
}

}  // namespace sahl
