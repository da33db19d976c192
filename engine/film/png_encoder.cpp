#include "engine/film/png_encoder.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <new>

namespace sahl {
namespace {

class PngEncoder final : public FileEncoder {
public:
    PngEncoder(const FileLayout& layout, std::vector<unsigned char>& file)
        : file_(file), row_bytes_(3 * static_cast<std::size_t>(layout.width)) {
        if (layout.encoding.pixel_type == PixelType::uint16) row_bytes_ *= 2;
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &fail, &ignore);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    }
    ~PngEncoder() override { png_destroy_write_struct(&png_, &info_); }
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;

    bool open(const FileLayout& layout) {
        if (info_ == nullptr) throw std::bad_alloc();
        const Encoding& encoding = layout.encoding;
        if (!guard([&] {
                png_set_write_fn(png_, this, &append, &flush);
                const int bits = encoding.pixel_type == PixelType::uint16 ? 16 : 8;
                png_set_IHDR(png_, info_, static_cast<png_uint_32>(layout.width),
                             static_cast<png_uint_32>(layout.height), bits, PNG_COLOR_TYPE_RGB,
                             PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
                if (encoding.transfer == Transfer::srgb) {
                    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
                } else {
                    png_set_gAMA(png_, info_, 1.0);
                }
                const int level = encoding.level.value_or(1);
                png_set_compression_level(png_, level);
                // Trying five filters on each row takes longer than the fastest compression does.
                png_set_filter(png_, PNG_FILTER_TYPE_DEFAULT, level <= 1 ? PNG_FILTER_UP : PNG_ALL_FILTERS);
                png_write_info(png_, info_);
                if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
            }))
            return false;
        head_size_ = static_cast<std::ptrdiff_t>(file_.size());
        return true;
    }

    bool write(int y, int y_end, const void* colors, std::span<const AovImage> /*aovs*/) override {
        return guard([&] {
            const auto* row = static_cast<const unsigned char*>(colors);
            for (; y < y_end; ++y, row += row_bytes_) png_write_row(png_, row);
        });
    }

    /// Texts are to stand before the pixels, where readers look for them. Chunks do not know where they are.
    bool finish(const Metadata& metadata) override {
        if (!guard([&] { png_write_end(png_, nullptr); })) return false;
        std::vector<unsigned char> texts;
        sink_ = &texts;
        for (const auto& [name, value] : metadata) {
            if (!add_text(name, value)) return false;
        }
        file_.insert(file_.begin() + head_size_, texts.begin(), texts.end());
        return true;
    }

    std::string error() const override { return error_; }

private:
    /// libpng ends what fails by a jump: between here and there nothing may have a destructor.
    template <class Work>
    bool guard(const Work& work) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng is C
        work();
        return true;
    }

    bool add_text(const std::string& name, const std::string& value) {
        const bool ascii =
            std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) >= 0; });
        std::string chunk = name;
        // Of iTXt: not compressed, no language, no translation of the name.
        chunk.append(ascii ? 1 : 5, '\0');
        chunk += value;
        return guard([&] {
            png_write_chunk(png_, reinterpret_cast<png_const_bytep>(ascii ? "tEXt" : "iTXt"),
                            reinterpret_cast<png_const_bytep>(chunk.data()), chunk.size());
        });
    }

    static void append(png_structp png, png_bytep bytes, png_size_t count) {
        std::vector<unsigned char>& sink = *static_cast<PngEncoder*>(png_get_io_ptr(png))->sink_;
        bool enough = true;
        try {
            sink.insert(sink.end(), bytes, bytes + count);
        } catch (const std::bad_alloc&) {
            enough = false;
        }
        if (!enough) png_error(png, "bad_alloc");
    }
    static void flush(png_structp /*png*/) {}

    [[noreturn]] static void fail(png_structp png, png_const_charp message) {
        static_cast<PngEncoder*>(png_get_error_ptr(png))->error_ = message;
        png_longjmp(png, 1);
    }
    static void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}

    std::vector<unsigned char>& file_;
    std::vector<unsigned char>* sink_ = &file_;  ///< of what libpng writes
    std::size_t row_bytes_;
    std::ptrdiff_t head_size_ = 0;  ///< of what comes before texts and pixels
    std::string error_{};
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

}  // namespace

std::unique_ptr<FileEncoder> encode_png(const FileLayout& layout, std::vector<unsigned char>& file,
                                        std::string& error) {
    auto encoder = std::make_unique<PngEncoder>(layout, file);
    if (encoder->open(layout)) return encoder;
    error = encoder->error();
    return nullptr;
}

}  // namespace sahl
