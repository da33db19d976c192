#include "engine/film/image_encode.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>
#include <string_view>

#include "engine/core/error.h"
#include "engine/film/image_codecs.h"
#include "engine/film/png_encoder.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t bytes_of(PixelType type) {
    switch (type) {
        case PixelType::uint8:
            return 1;
        case PixelType::uint16:
        case PixelType::half:
            return 2;
        case PixelType::float32:
            break;
    }
    return 4;
}

/// All channels of a pixel, uncompressed; HDR's four bytes count as three floats.
std::uint64_t pixel_bytes(const Encoding& encoding, std::span<const Aov> aovs) {
    const std::uint64_t color = bytes_of(encoding.pixel_type);
    std::uint64_t bytes = 3 * color;
    for (const Aov aov : aovs) bytes += channels_of(aov) * (aov == Aov::albedo ? color : 4);
    return bytes;
}

/// Of a file with `raw` bytes of pixels: compression can make noise larger (LZW by half), and there are
/// headers.
std::uint64_t most_file_bytes(std::uint64_t raw) { return raw + raw / 2 + (std::uint64_t{1} << 20U); }

/// What the colours of a band of rows are for the encoder.
class BandColors {
public:
    BandColors(const Encoding& encoding, float exposure) : encoding_(encoding), exposure_(exposure) {}

    /// As FileEncoder::write takes them.
    const void* of(std::span<const float> values) {
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
        return floats_.data();
    }

private:
    Encoding encoding_;
    float exposure_;
    std::vector<std::uint8_t> bytes_{};
    std::vector<std::uint16_t> words_{};
    std::vector<float> floats_{};
};

void check_aovs(const fs::path& path, const Image& image, std::span<const AovImage> aovs) {
    if (aovs.empty()) return;
    if (!can_hold_aovs(path))
        throw Error(ExitCode::usage,
                    "'" + path.string() + "': this format has no room for AOVs; use EXR for them");
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (const AovImage& aov : aovs) {
        const AovName& name = aov_name(aov.aov);
        const std::size_t count = channels_of(aov.aov) * pixels;
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

struct ImageEncoder::Impl {
    Impl(fs::path file_path, const FileLayout& file_layout, float exposure)
        : path(std::move(file_path)),
          width(static_cast<std::size_t>(file_layout.width)),
          colors(file_layout.encoding, exposure) {
        // Room for the whole file, of which only what is used becomes memory: growing would copy it.
        file.reserve(most_file_bytes(pixel_bytes(file_layout.encoding, file_layout.aovs) * width *
                                     static_cast<std::uint64_t>(file_layout.height)));
        std::string cause;
        encoder = is_png(*file_layout.encoding.format)
                      ? encode_png(file_layout, file, cause)
                      : image_codecs(ExitCode::output).encode(file_layout, file, cause);
        if (!encoder) fail(cause);
    }

    [[noreturn]] void fail(const std::string& cause) const {
        if (cause.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // caught on its way
        throw Error(ExitCode::output,
                    "cannot encode '" + path.string() + "': " + cause + "; choose another format");
    }

    fs::path path;
    std::size_t width;
    BandColors colors;
    int rows = 0;  ///< that were added
    std::vector<unsigned char> file{};
    std::unique_ptr<FileEncoder> encoder{};
};

ImageEncoder::ImageEncoder(fs::path path, const FileLayout& layout, float exposure)
    : impl_(std::make_unique<Impl>(std::move(path), layout, exposure)) {}
ImageEncoder::~ImageEncoder() = default;

void ImageEncoder::add(std::span<const float> colors, std::span<const AovImage> aovs) {
    const int end = impl_->rows + static_cast<int>(colors.size() / (3 * impl_->width));
    if (!impl_->encoder->write(impl_->rows, end, impl_->colors.of(colors), aovs))
        impl_->fail(impl_->encoder->error());
    impl_->rows = end;
}

std::vector<unsigned char> ImageEncoder::finish(const Metadata& metadata) {
    if (!impl_->encoder->finish(metadata)) impl_->fail(impl_->encoder->error());
    impl_->encoder.reset();
    return std::move(impl_->file);
}

std::vector<unsigned char> encode(const fs::path& path, const Image& image, std::span<const AovImage> aovs,
                                  const Encoding& encoding, const OutputSettings& settings) {
    check_aovs(path, image, aovs);
    std::vector<Aov> layers;
    for (const AovImage& aov : aovs) layers.push_back(aov.aov);
    ImageEncoder encoder(path, {image.width, image.height, encoding, layers, settings.metadata},
                         settings.exposure);
    const std::size_t band = band_rows * 3 * static_cast<std::size_t>(image.width);
    const std::span<const float> colors(image.pixels);
    for (std::size_t begin = 0; begin < colors.size(); begin += band)
        encoder.add(colors.subspan(begin, std::min(band, colors.size() - begin)), aovs);
    return encoder.finish(settings.metadata);
}

}  // namespace sahl
