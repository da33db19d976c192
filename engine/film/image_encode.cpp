#include "engine/film/image_encode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "engine/core/error.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::array pixel_types{OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                 OIIO::TypeDesc::FLOAT};

OIIO::TypeDesc type_of(PixelType type) { return pixel_types[static_cast<std::size_t>(type)]; }

OIIO::TypeDesc type_of(Aov aov, const Encoding& encoding) {
    if (aov_name(aov).is_uint) return OIIO::TypeDesc::UINT;
    return aov == Aov::albedo ? type_of(encoding.pixel_type) : OIIO::TypeDesc::FLOAT;
}

int channels_of(Aov aov) { return std::max(static_cast<int>(aov_name(aov).components.size()), 1); }

constexpr int band_rows = 256;  ///< whole compression blocks of EXR (16, 32 or 256 rows) and TIFF (32)

/// All channels of a pixel, uncompressed; HDR's four bytes count as three floats.
std::uint64_t pixel_bytes(const Encoding& encoding, std::span<const Aov> aovs) {
    std::uint64_t bytes = 3 * type_of(encoding.pixel_type).size();
    for (const Aov aov : aovs)
        bytes += static_cast<std::uint64_t>(channels_of(aov)) * type_of(aov, encoding).size();
    return bytes;
}

/// Of a file with `raw` bytes of pixels: compression can make noise larger (LZW by half), and there are
/// headers.
std::uint64_t most_file_bytes(std::uint64_t raw) { return raw + raw / 2 + (std::uint64_t{1} << 20U); }

void add_channels(OIIO::ImageSpec& spec, std::span<const AovImage> aovs, const Encoding& encoding) {
    if (aovs.empty()) return;
    spec.channelformats.assign(3, spec.format);
    for (const AovImage& image : aovs) {
        const AovName& name = aov_name(image.aov);
        for (int c = 0; c < channels_of(image.aov); ++c) {
            std::string channel(name.name);
            if (!name.components.empty())
                channel += std::string(".") + name.components[static_cast<std::size_t>(c)];
            spec.channelnames.push_back(std::move(channel));
            spec.channelformats.push_back(type_of(image.aov, encoding));
        }
    }
    spec.nchannels = static_cast<int>(spec.channelnames.size());
}

OIIO::ImageSpec spec_of(const Image& image, std::span<const AovImage> aovs, const Encoding& encoding,
                        const OutputSettings& settings) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type_of(encoding.pixel_type));
    add_channels(spec, aovs, encoding);
    const std::string_view format = encoding.format->name;
    // This names the colour space in the file (PNG: sRGB or gAMA chunk) and converts nothing. TIFF
    // would get an EXIF directory, which OpenImageIO 2.4 writes damaged into memory.
    if (format != "tiff")
        spec.attribute("oiio:ColorSpace", encoding.transfer == Transfer::srgb ? "sRGB" : "Linear");
    if (format == "png") {
        spec.attribute("png:compressionLevel", encoding.level.value_or(1));
    } else if (format == "jpeg") {
        spec.attribute("Compression", "jpeg:" + std::to_string(encoding.level.value_or(95)));
        spec.attribute("jpeg:subsampling", "4:4:4");
    } else if (!encoding.compression.empty()) {
        std::string compression(encoding.compression);
        if (encoding.level) compression += ":" + std::to_string(*encoding.level);
        spec.attribute("compression", compression);
    }
    for (const auto& [name, value] : settings.metadata) spec.attribute(name, value);
    return spec;
}

/// What a band of rows is in the file.
class BandEncoder {
public:
    BandEncoder(const Image& image, std::span<const AovImage> aovs, const Encoding& encoding, float exposure)
        : image_(image), aovs_(aovs), encoding_(encoding), exposure_(exposure) {}

    /// OpenImageIO's type of data(): `unknown` where channels have types of their own.
    OIIO::TypeDesc type() const {
        if (!aovs_.empty()) return OIIO::TypeDesc::UNKNOWN;
        return is_integer(encoding_.pixel_type) ? type_of(encoding_.pixel_type) : OIIO::TypeDesc::FLOAT;
    }

    const void* encode(int y, int y_end) {
        const std::size_t row = 3 * static_cast<std::size_t>(image_.width);
        const auto values =
            std::span(image_.pixels)
                .subspan(row * static_cast<std::size_t>(y), row * static_cast<std::size_t>(y_end - y));
        switch (encoding_.pixel_type) {
            case PixelType::uint8:
                bytes_.resize(values.size());
                quantize(values, exposure_, encoding_.transfer, encoding_.rounding, std::span(bytes_));
                return bytes_.data();
            case PixelType::uint16:
                words_.resize(values.size());
                quantize(values, exposure_, encoding_.transfer, encoding_.rounding, std::span(words_));
                return words_.data();
            case PixelType::half:
            case PixelType::float32:
                break;
        }
        const float largest =
            encoding_.pixel_type == PixelType::half ? 65504.0F : std::numeric_limits<float>::max();
        const bool negatives = std::string_view(encoding_.format->name) != "hdr";
        floats_.assign(values.begin(), values.end());
        expose(floats_, exposure_, negatives ? -largest : 0.0F, largest);
        return aovs_.empty() ? static_cast<const void*>(floats_.data()) : interleave(y, y_end);
    }

private:
    /// All channels of a pixel beside each other, each in its type.
    const void* interleave(int y, int y_end) {
        const OIIO::TypeDesc color = type_of(encoding_.pixel_type);
        std::size_t pixel_size = 3 * color.size();
        for (const AovImage& aov : aovs_)
            pixel_size += static_cast<std::size_t>(channels_of(aov.aov)) * type_of(aov.aov, encoding_).size();
        const auto pixels = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(y_end - y);
        const std::size_t first = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(y);
        bytes_.resize(pixels * pixel_size);
        std::size_t offset = 0;
        const auto put = [&](int channels, const void* from, OIIO::TypeDesc from_type, OIIO::TypeDesc type) {
            const auto count = static_cast<std::size_t>(channels);
            OIIO::convert_image(channels, static_cast<int>(pixels), 1, 1, from, from_type,
                                static_cast<OIIO::stride_t>(count * from_type.size()), OIIO::AutoStride,
                                OIIO::AutoStride, bytes_.data() + offset, type,
                                static_cast<OIIO::stride_t>(pixel_size), OIIO::AutoStride, OIIO::AutoStride);
            offset += count * type.size();
        };
        put(3, floats_.data(), OIIO::TypeDesc::FLOAT, color);
        for (const AovImage& aov : aovs_) {
            const int channels = channels_of(aov.aov);
            const OIIO::TypeDesc type = type_of(aov.aov, encoding_);
            if (aov_name(aov.aov).is_uint) {
                put(channels, aov.uints.data() + first, OIIO::TypeDesc::UINT, type);
            } else {
                put(channels, aov.values.data() + first * static_cast<std::size_t>(channels),
                    OIIO::TypeDesc::FLOAT, type);
            }
        }
        return bytes_.data();
    }

    const Image& image_;
    std::span<const AovImage> aovs_;
    const Encoding& encoding_;
    float exposure_;
    std::vector<std::uint8_t> bytes_;
    std::vector<std::uint16_t> words_;
    std::vector<float> floats_;
};

void check_aovs(const fs::path& path, const Image& image, std::span<const AovImage> aovs) {
    if (aovs.empty()) return;
    if (!can_hold_aovs(path))
        throw Error(ExitCode::usage,
                    "'" + path.string() + "': this format has no room for AOVs; use EXR for them");
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (const AovImage& aov : aovs) {
        const AovName& name = aov_name(aov.aov);
        const std::size_t count = static_cast<std::size_t>(channels_of(aov.aov)) * pixels;
        if ((name.is_uint ? aov.uints.size() : aov.values.size()) != count)
            throw Error(ExitCode::internal, "AOV " + std::string(name.name) + " is not as large as the " +
                                                "image; please report this");
    }
}

}  // namespace

std::uint64_t encoder_bytes(const Encoding& encoding, int width, int height, std::span<const Aov> aovs) {
    const std::uint64_t pixel = pixel_bytes(encoding, aovs);
    const std::uint64_t row = pixel * static_cast<std::uint64_t>(width);
    // Floats, what they become, and what the library makes of that before and while it compresses.
    const auto rows = static_cast<std::uint64_t>(std::min(band_rows, height));
    const std::uint64_t bands = rows * (static_cast<std::uint64_t>(width) * 3 * sizeof(float) + 4 * row);
    return most_file_bytes(row * static_cast<std::uint64_t>(height)) + bands;
}

std::vector<unsigned char> encode(const fs::path& path, const Image& image, std::span<const AovImage> aovs,
                                  const Encoding& encoding, const OutputSettings& settings) {
    check_aovs(path, image, aovs);
    std::vector<unsigned char> file;
    std::vector<Aov> layers;
    for (const AovImage& aov : aovs) layers.push_back(aov.aov);
    // Room for the whole file, of which only what is used becomes memory: growing would copy it.
    file.reserve(most_file_bytes(pixel_bytes(encoding, layers) * static_cast<std::uint64_t>(image.width) *
                                 static_cast<std::uint64_t>(image.height)));
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
                       spec_of(image, aovs, encoding, settings)));
    BandEncoder bands(image, aovs, encoding, settings.exposure);
    for (int y = 0; y < image.height; y += band_rows) {
        const int y_end = std::min(y + band_rows, image.height);
        check(output->write_scanlines(y, y_end, 0, bands.type(), bands.encode(y, y_end)));
    }
    check(output->close());
    return file;
}

}  // namespace sahl
