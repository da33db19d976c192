// Image files through OpenImageIO: what each format can hold, writing and reading.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/film/film.h"
#include "engine/film/transfer.h"

namespace sahl {

/// How a channel is stored. `uint8` and `uint16` hold [0, 1] as 0..max.
enum class PixelType { uint8, uint16, half, float32 };

/// Formats by extension, of any case; the first pixel type is the default:
///   .exr         half, float32
///   .png         uint8, uint16     zlib level 1, RGB without alpha
///   .jpg .jpeg   uint8             quality 95, no chroma subsampling
///   .hdr         float32           stored as RGBE: within 1/128 of a pixel's largest channel, no negatives
///   .tif .tiff   uint8, uint16, float32
struct OutputSettings {
    std::optional<PixelType> pixel_type{};  ///< none: the format's default
    std::optional<Transfer> transfer{};   ///< none: srgb for integers, linear for floats, which hold no other
    Rounding rounding = Rounding::round;  ///< of integers
    float exposure = 0;                   ///< in stops: values are multiplied by 2^exposure first
    /// Names and values that go into EXR and PNG files as they are; TIFF and JPEG keep those they
    /// have tags for (Software, DateTime, …), HDR none.
    std::vector<std::pair<std::string, std::string>> metadata{};
};

/// To be called before rendering: throws Error(usage) for an extension that is no image format and
/// for settings that the format cannot hold, listing what it can; Error(output) for a path that
/// cannot be written (see check_output_file). Changes nothing.
void check_output(const std::filesystem::path& path, const OutputSettings& settings);

/// Writes `image` (3 channels) in the format of the extension, encoded in memory first, then as
/// write_file does. A special file without an extension, such as /dev/null, gets a PNG.
/// NaN is stored as 0; values beyond what half or float hold as the largest finite value.
/// Throws as check_output, Error(output) for what fails in encoding or writing.
void write_image(const std::filesystem::path& path, const Image& image, const OutputSettings& settings);

/// Reads any image that OpenImageIO knows into 3 channels: one channel is replicated, channels
/// after the third are dropped. Values as stored, 8-bit code v as v/255, no transfer function.
/// Throws Error(scene) for a missing, damaged or unknown file or one larger than 65536x65536,
/// Error(memory) for one that does not fit into this machine's memory.
Image read_image(const std::filesystem::path& path);

}  // namespace sahl
