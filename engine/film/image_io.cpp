#include "engine/film/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <new>
#include <span>
#include <string_view>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr int max_size = 65536;

struct Format {
    const char* name;  ///< OpenImageIO's
    std::vector<std::string_view> extensions;
    std::vector<PixelType> pixel_types;
};

const std::array<Format, 5>& formats() {
    using enum PixelType;
    static const std::array<Format, 5> table{{
        {.name = "openexr", .extensions = {".exr"}, .pixel_types = {half, float32}},
        {.name = "png", .extensions = {".png"}, .pixel_types = {uint8, uint16}},
        {.name = "jpeg", .extensions = {".jpg", ".jpeg"}, .pixel_types = {uint8}},
        {.name = "hdr", .extensions = {".hdr"}, .pixel_types = {float32}},
        {.name = "tiff", .extensions = {".tif", ".tiff"}, .pixel_types = {uint8, uint16, float32}},
    }};
    return table;
}

const char* name_of(PixelType type) {
    switch (type) {
        case PixelType::uint8:
            return "uint8";
        case PixelType::uint16:
            return "uint16";
        case PixelType::half:
            return "half";
        case PixelType::float32:
            return "float";
    }
    return "";
}

bool is_integer(PixelType type) { return type == PixelType::uint8 || type == PixelType::uint16; }

template <typename Range, typename Text>
std::string join(const Range& items, Text text) {
    std::string all;
    for (const auto& item : items) all += (all.empty() ? "" : ", ") + std::string(text(item));
    return all;
}

const Format& format_of(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension.empty() && is_special_file(path)) extension = ".png";
    std::string known;
    for (const Format& format : formats()) {
        if (std::find(format.extensions.begin(), format.extensions.end(), extension) !=
            format.extensions.end())
            return format;
        known += (known.empty() ? "" : ", ") + join(format.extensions, [](auto text) { return text; });
    }
    throw Error(ExitCode::usage,
                "'" + path.string() + "' has no extension of an image format; use one of " + known);
}

/// What a file is going to be; throws Error(usage) where that contradicts itself.
struct Encoding {
    const Format* format;
    PixelType pixel_type;
    Transfer transfer;
};

Encoding encoding_of(const fs::path& path, const OutputSettings& settings) {
    const Format& format = format_of(path);
    const PixelType type = settings.pixel_type.value_or(format.pixel_types.front());
    if (std::find(format.pixel_types.begin(), format.pixel_types.end(), type) == format.pixel_types.end())
        throw Error(ExitCode::usage, "'" + path.string() + "': pixel type " + name_of(type) +
                                         " does not fit this format, which holds " +
                                         join(format.pixel_types, name_of));
    const Transfer transfer =
        settings.transfer.value_or(is_integer(type) ? Transfer::srgb : Transfer::linear);
    if (transfer == Transfer::srgb && !is_integer(type))
        throw Error(ExitCode::usage, "'" + path.string() + "': " + name_of(type) +
                                         " pixels are linear; leave the transfer out, or use uint8 or uint16 "
                                         "pixels (in PNG or TIFF)");
    return {.format = &format, .pixel_type = type, .transfer = transfer};
}

OIIO::ImageSpec spec_of(const Image& image, const Encoding& encoding, const OutputSettings& settings) {
    static constexpr std::array types{OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                      OIIO::TypeDesc::FLOAT};
    OIIO::ImageSpec spec(image.width, image.height, image.channels,
                         types[static_cast<std::size_t>(encoding.pixel_type)]);
    const std::string_view format = encoding.format->name;
    // This names the colour space in the file (PNG: sRGB or gAMA chunk) and converts nothing. TIFF
    // would get an EXIF directory, which OpenImageIO 2.4 writes damaged into memory.
    if (format != "tiff")
        spec.attribute("oiio:ColorSpace", encoding.transfer == Transfer::srgb ? "sRGB" : "Linear");
    if (format == "png") spec.attribute("png:compressionLevel", 1);
    if (format == "jpeg") {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    for (const auto& [name, value] : settings.metadata) spec.attribute(name, value);
    return spec;
}

/// Converts and encodes a band of rows at a time.
std::vector<unsigned char> encode(const fs::path& path, const Image& image, const Encoding& encoding,
                                  const OutputSettings& settings) {
    std::vector<unsigned char> file;
    OIIO::Filesystem::IOVecOutput memory(file);
    const auto output = OIIO::ImageOutput::create(encoding.format->name);
    const auto check = [&](bool done) {
        if (!done)
            throw Error(ExitCode::output, "cannot encode '" + path.string() +
                                              "': " + (output ? output->geterror() : OIIO::geterror()) +
                                              "; choose another format");
    };
    check(output && output->set_ioproxy(&memory));
    check(output->open(std::string("memory") + std::string(encoding.format->extensions.front()),
                       spec_of(image, encoding, settings)));

    const float largest =
        encoding.pixel_type == PixelType::half ? 65504.0F : std::numeric_limits<float>::max();
    const bool negatives = std::string_view(encoding.format->name) != "hdr";
    constexpr int band = 256;  // whole compression blocks of EXR (16 rows) and TIFF (32)
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> words;
    std::vector<float> floats;
    for (int y = 0; y < image.height; y += band) {
        const int y_end = std::min(y + band, image.height);
        const auto values =
            std::span(image.pixels)
                .subspan(row * static_cast<std::size_t>(y), row * static_cast<std::size_t>(y_end - y));
        const auto write = [&](OIIO::TypeDesc type, const void* data) {
            check(output->write_scanlines(y, y_end, 0, type, data));
        };
        switch (encoding.pixel_type) {
            case PixelType::uint8:
                bytes.resize(values.size());
                quantize(values, settings.exposure, encoding.transfer, settings.rounding, std::span(bytes));
                write(OIIO::TypeDesc::UINT8, bytes.data());
                break;
            case PixelType::uint16:
                words.resize(values.size());
                quantize(values, settings.exposure, encoding.transfer, settings.rounding, std::span(words));
                write(OIIO::TypeDesc::UINT16, words.data());
                break;
            case PixelType::half:
            case PixelType::float32:
                floats.assign(values.begin(), values.end());
                expose(floats, settings.exposure, negatives ? -largest : 0.0F, largest);
                write(OIIO::TypeDesc::FLOAT, floats.data());
                break;
        }
    }
    check(output->close());
    return file;
}

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

void write_image(const fs::path& path, const Image& image, const OutputSettings& settings) {
    const std::vector<unsigned char> file = encode(path, image, encoding_of(path, settings), settings);
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

    const int stored = spec.nchannels < 3 ? 1 : 3;
    const std::size_t values =
        3 * static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    if (values * sizeof(float) > physical_memory()) throw std::bad_alloc();
    Image image{
        .width = spec.width, .height = spec.height, .channels = 3, .pixels = std::vector<float>(values)};
    constexpr OIIO::stride_t pixel = 3 * sizeof(float);
    if (!input->read_image(0, 0, 0, stored, OIIO::TypeDesc::FLOAT, image.pixels.data(), pixel))
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
