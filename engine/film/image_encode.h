// An image file's bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "engine/film/file_encoder.h"

namespace sahl {

/// What encode() takes beside its arguments, at most: the file and the bands on their way into it.
std::uint64_t encoder_bytes(const Encoding& encoding, int width, int height, std::span<const Aov> aovs);

constexpr int band_rows = 256;  ///< whole compression blocks of EXR (16, 32 or 256 rows) and TIFF (32)

/// Encodes a file band by band: rows of colours, and of AOVs, as write_image stores them.
class ImageEncoder {
public:
    /// `path` is for messages. Throws Error(output) for what fails, here and below.
    ImageEncoder(std::filesystem::path path, const FileLayout& layout, float exposure);
    ~ImageEncoder();
    ImageEncoder(const ImageEncoder&) = delete;
    ImageEncoder& operator=(const ImageEncoder&) = delete;

    /// The rows that follow those before, at most band_rows, each but the last call's whole blocks. `colors`:
    /// three floats a pixel. `aovs`: of the layout, whole images.
    void add(std::span<const float> colors, std::span<const AovImage> aovs);
    /// The file, after its last row. `metadata`: see FileEncoder::finish.
    std::vector<unsigned char> finish(const Metadata& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// `image` with `aovs` as write_image stores them, converted and encoded a band of rows at a time.
/// `path` is for messages. Throws Error(output) for what fails, Error(usage) for AOVs that the format
/// has no room for.
std::vector<unsigned char> encode(const std::filesystem::path& path, const Image& image,
                                  std::span<const AovImage> aovs, const Encoding& encoding,
                                  const OutputSettings& settings);

}  // namespace sahl
