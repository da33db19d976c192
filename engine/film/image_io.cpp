#include "engine/film/image_io.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>
#include <span>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/film/image_encode.h"
#include "engine/film/image_format.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr int max_size = 65536;

[[noreturn]] void fail_reading(const fs::path& path, std::string cause) {
    while (!cause.empty() && std::isspace(static_cast<unsigned char>(cause.back()))) cause.pop_back();
    throw Error(ExitCode::scene, "cannot read image '" + path.string() + "': " + cause +
                                     "; give an image file such as EXR, PNG, JPEG, HDR or TIFF");
}

std::size_t physical_memory() {
    return static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::size_t>(::sysconf(_SC_PAGE_SIZE));
}

}  // namespace

void check_output(const fs::path& path, const OutputSettings& settings) {
    encoding_of(path, settings);
    check_output_file(path);
}

void write_image(const fs::path& path, const Image& image, const OutputSettings& settings,
                 std::span<const AovImage> aovs) {
    const std::vector<unsigned char> file = encode(path, image, aovs, encoding_of(path, settings), settings);
    write_file(path, std::as_bytes(std::span(file)));
}

Image read_image(const fs::path& path) try {
    std::error_code cause;
    const fs::file_status status = fs::status(path, cause);
    if (!fs::exists(status)) fail_reading(path, cause.message());
    if (fs::is_directory(status)) fail_reading(path, "it is a folder");

    OIIO::ImageSpec as_stored;  // or colours come multiplied by alpha
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path.string(), &as_stored);
    if (!input) fail_reading(path, OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.deep || spec.depth > 1 || spec.nchannels < 1) fail_reading(path, "it holds no flat image");
    if (spec.width < 1 || spec.height < 1 || spec.width > max_size || spec.height > max_size)
        fail_reading(path, "it claims a size of " + std::to_string(spec.width) + "x" +
                               std::to_string(spec.height) + ", where at most 65536x65536 is allowed");

    const auto red = std::find(spec.channelnames.begin(), spec.channelnames.end(), "R");
    const bool named = spec.channelnames.end() - red >= 3 && red[1] == "G" && red[2] == "B";
    const int first = named ? static_cast<int>(red - spec.channelnames.begin()) : 0;
    const int stored = spec.nchannels < 3 ? 1 : 3;
    const std::size_t values =
        3 * static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    if (values * sizeof(float) > physical_memory()) throw std::bad_alloc();
    Image image{
        .width = spec.width, .height = spec.height, .channels = 3, .pixels = std::vector<float>(values)};
    constexpr OIIO::stride_t pixel = 3 * sizeof(float);
    if (!input->read_image(0, 0, first, first + stored, OIIO::TypeDesc::FLOAT, image.pixels.data(), pixel))
        fail_reading(path, input->geterror());
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
    throw Error(ExitCode::memory,
                "image '" + path.string() + "' does not fit into memory; use a smaller image");
}

}  // namespace sahl
