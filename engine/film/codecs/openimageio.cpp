// The library behind image_codecs.h. It takes from the engine what headers have, and no more: what it were
// linked with would be in the process twice.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "engine/film/image_codecs.h"

namespace sahl {
namespace {

constexpr std::array pixel_types{OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                 OIIO::TypeDesc::FLOAT};

OIIO::TypeDesc type_of(PixelType type) { return pixel_types[static_cast<std::size_t>(type)]; }

OIIO::TypeDesc type_of(Aov aov, const Encoding& encoding) {
    if (aov_name(aov).is_uint) return OIIO::TypeDesc::UINT;
    return aov == Aov::albedo ? type_of(encoding.pixel_type) : OIIO::TypeDesc::FLOAT;
}

void add_channels(OIIO::ImageSpec& spec, const FileLayout& layout) {
    if (layout.aovs.empty()) return;
    spec.channelformats.assign(3, spec.format);
    for (const Aov aov : layout.aovs) {
        const AovName& name = aov_name(aov);
        for (std::size_t c = 0; c < channels_of(aov); ++c) {
            std::string channel(name.name);
            if (!name.components.empty()) channel += std::string(".") + name.components[c];
            spec.channelnames.push_back(std::move(channel));
            spec.channelformats.push_back(type_of(aov, layout.encoding));
        }
    }
    spec.nchannels = static_cast<int>(spec.channelnames.size());
}

OIIO::ImageSpec spec_of(const FileLayout& layout) {
    const Encoding& encoding = layout.encoding;
    OIIO::ImageSpec spec(layout.width, layout.height, 3, type_of(encoding.pixel_type));
    add_channels(spec, layout);
    const std::string_view format = encoding.format->name;
    // This names the colour space in the file and converts nothing. TIFF would get an EXIF directory, which
    // OpenImageIO 2.4 writes damaged into memory.
    if (format != "tiff")
        spec.attribute("oiio:ColorSpace", encoding.transfer == Transfer::srgb ? "sRGB" : "Linear");
    if (format == "jpeg") {
        spec.attribute("Compression", "jpeg:" + std::to_string(encoding.level.value_or(95)));
        spec.attribute("jpeg:subsampling", "4:4:4");
    } else if (!encoding.compression.empty()) {
        std::string compression(encoding.compression);
        if (encoding.level) compression += ":" + std::to_string(*encoding.level);
        spec.attribute("compression", compression);
    }
    for (const auto& [name, value] : layout.metadata) spec.attribute(name, value);
    return spec;
}

class Encoder final : public FileEncoder {
public:
    Encoder(const FileLayout& layout, std::vector<unsigned char>& file)
        : layout_(layout),
          memory_(file),
          output_(OIIO::ImageOutput::create(layout.encoding.format->name)),
          color_(type_of(layout.encoding.pixel_type)),
          given_color_(is_integer(layout.encoding.pixel_type) ? color_ : OIIO::TypeDesc::FLOAT) {}

    bool open() {
        if (!output_ || !output_->set_ioproxy(&memory_)) return false;
        const std::string extension(layout_.encoding.format->extensions.front());
        return output_->open("memory" + extension, spec_of(layout_));
    }

    bool write(int y, int y_end, const void* colors, std::span<const AovImage> aovs) override {
        if (aovs.empty()) return output_->write_scanlines(y, y_end, 0, given_color_, colors);
        // Each channel has a type of its own.
        return output_->write_scanlines(y, y_end, 0, OIIO::TypeDesc::UNKNOWN,
                                        interleave(y, y_end, colors, aovs));
    }

    bool finish(const Metadata& /*metadata*/) override { return output_->close(); }

    std::string error() const override { return output_ ? output_->geterror() : OIIO::geterror(); }

private:
    /// All channels of a pixel beside each other, each in its type.
    const void* interleave(int y, int y_end, const void* colors, std::span<const AovImage> aovs) {
        std::size_t pixel_size = 3 * color_.size();
        for (const AovImage& aov : aovs)
            pixel_size += channels_of(aov.aov) * type_of(aov.aov, layout_.encoding).size();
        const auto width = static_cast<std::size_t>(layout_.width);
        const std::size_t pixels = width * static_cast<std::size_t>(y_end - y);
        const std::size_t first = width * static_cast<std::size_t>(y);
        bytes_.resize(pixels * pixel_size);
        std::size_t offset = 0;
        const auto put = [&](std::size_t channels, const void* from, OIIO::TypeDesc from_type,
                             OIIO::TypeDesc type) {
            OIIO::convert_image(static_cast<int>(channels), static_cast<int>(pixels), 1, 1, from, from_type,
                                static_cast<OIIO::stride_t>(channels * from_type.size()), OIIO::AutoStride,
                                OIIO::AutoStride, bytes_.data() + offset, type,
                                static_cast<OIIO::stride_t>(pixel_size), OIIO::AutoStride, OIIO::AutoStride);
            offset += channels * type.size();
        };
        put(3, colors, given_color_, color_);
        for (const AovImage& aov : aovs) {
            const std::size_t channels = channels_of(aov.aov);
            const OIIO::TypeDesc type = type_of(aov.aov, layout_.encoding);
            if (aov_name(aov.aov).is_uint) {
                put(channels, aov.uints.data() + first, OIIO::TypeDesc::UINT, type);
            } else {
                put(channels, aov.values.data() + first * channels, OIIO::TypeDesc::FLOAT, type);
            }
        }
        return bytes_.data();
    }

    FileLayout layout_;
    OIIO::Filesystem::IOVecOutput memory_;
    std::unique_ptr<OIIO::ImageOutput> output_;
    OIIO::TypeDesc color_;        ///< in the file
    OIIO::TypeDesc given_color_;  ///< as it comes
    std::vector<std::uint8_t> bytes_{};
};

class Decoder final : public FileDecoder {
public:
    explicit Decoder(std::unique_ptr<OIIO::ImageInput> input) : input_(std::move(input)) {
        const OIIO::ImageSpec& spec = input_->spec();
        image_.width = spec.width;
        image_.height = spec.height;
        image_.is_flat = !spec.deep && spec.depth <= 1;
        image_.channels = spec.channelnames;
        image_.channels.resize(static_cast<std::size_t>(std::max(spec.nchannels, 0)));
        if (spec.format == OIIO::TypeDesc::UINT8) image_.largest_code = 255;
        if (spec.format == OIIO::TypeDesc::UINT16) image_.largest_code = 65535;
    }

    const StoredImage& image() const override { return image_; }

    bool read(int first, int count, float* pixels) override {
        constexpr OIIO::stride_t pixel = 3 * sizeof(float);
        return input_->read_image(0, 0, first, first + count, OIIO::TypeDesc::FLOAT, pixels, pixel);
    }

    std::string error() const override { return input_->geterror(); }

private:
    std::unique_ptr<OIIO::ImageInput> input_;
    StoredImage image_{};
};

std::unique_ptr<FileEncoder> encode(const FileLayout& layout, std::vector<unsigned char>& file,
                                    std::string& error) {
    auto encoder = std::make_unique<Encoder>(layout, file);
    if (encoder->open()) return encoder;
    error = encoder->error();
    return nullptr;
}

std::unique_ptr<FileDecoder> decode(const std::string& path, std::string& error) {
    OIIO::ImageSpec as_stored;  // or colours come multiplied by alpha
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    auto input = OIIO::ImageInput::open(path, &as_stored);
    if (input) return std::make_unique<Decoder>(std::move(input));
    error = OIIO::geterror();
    return nullptr;
}

void use_one_thread() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);  // OpenEXR's own: none
}

constexpr ImageCodecs codecs{&encode, &decode, &use_one_thread};

}  // namespace
}  // namespace sahl

extern "C" __attribute__((visibility("default"))) const sahl::ImageCodecs* sahl_image_codecs_1();
const sahl::ImageCodecs* sahl_image_codecs_1() { return &sahl::codecs; }
