// Image files: what each format can hold, writing and reading. PNG is written by libpng, all else is done by
// OpenImageIO, in a library that is loaded when it is first needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/film/aov.h"
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
    std::optional<Transfer> transfer{};  ///< none: srgb for integers, linear for floats, which hold no other
    std::optional<Rounding> rounding{};  ///< of integers; none: round
    float exposure = 0;                  ///< in stops: values are multiplied by 2^exposure first
    /// EXR: none, rle, zips, zip (default), piz, pxr24, b44, b44a, dwaa:1..500, dwab:1..500 (45; the last
    /// five lose precision, pxr24 of Z and N too); TIFF: none, lzw, zip (default), packbits; JPEG:
    /// jpeg:1..100 (quality); PNG: zip:0..9. The level may be left out.
    std::optional<std::string> compression{};
    /// Names and values that go into EXR and PNG files as they are; TIFF and JPEG keep those they
    /// have tags for (Software, DateTime, …), HDR none.
    std::vector<std::pair<std::string, std::string>> metadata{};
};

/// Names of all formats' compressions, without levels.
std::vector<std::string> compression_names();

/// Whether the format of `path` has room for AOVs. Throws as check_output.
bool can_hold_aovs(const std::filesystem::path& path);

/// `settings` for each of several files: without the pixel type, the transfer, the rounding and the
/// compression that its format cannot hold. Throws Error(usage) for one that no file can, listing
/// what each can. A single file's settings stay as they are, for check_output to judge.
std::vector<OutputSettings> settings_for(std::span<const std::filesystem::path> paths,
                                         const OutputSettings& settings);

/// To be called before rendering: throws Error(usage) for an extension that is no image format and
/// for settings that the format cannot hold, listing what it can; Error(output) for a path that
/// cannot be written (see check_output_file). Changes nothing.
void check_output(const std::filesystem::path& path, const OutputSettings& settings);

/// The same but for whether anything can be written there.
void check_output_format(const std::filesystem::path& path, const OutputSettings& settings);

/// Loads what encodes an image to `path`: nothing for PNG, for other formats OpenImageIO, a fifth of a
/// second's work, in a thread of its own from the first call on. To be called again and again while the image
/// is rendered: throws Error(output) once it is known that it cannot be loaded. Throws as
/// check_output_format for the extension.
void load_encoder(const std::filesystem::path& path);

/// Returns when it is loaded: beside work that takes all memory it could not be. Throws as load_encoder.
void wait_for_encoder(const std::filesystem::path& path);

/// What write_image takes of memory beside the image and the AOVs, at most: the file and bands of rows
/// on their way into it. Throws as check_output does for what the format cannot hold.
std::uint64_t encoder_bytes(const std::filesystem::path& path, const OutputSettings& settings, int width,
                            int height, std::span<const Aov> aovs);

/// The bytes of the file that write_image would write to `path`. Throws as it does, but for writing.
std::vector<unsigned char> encode_image(const std::filesystem::path& path, const Image& image,
                                        const OutputSettings& settings, std::span<const AovImage> aovs = {});

/// Writes `image` (3 channels) in the format of the extension, encoded in memory first, then as
/// write_file does. A special file without an extension, such as /dev/null, gets a PNG.
/// NaN is stored as 0; values beyond what half or float hold as the largest finite value.
/// `aovs` (of the image's size, EXR only) are stored beside R, G and B in channels of their own, see
/// aov_names: as they are, Z and N as float, albedo in the pixel type, ids as unsigned integers.
/// Throws as check_output and load_encoder, Error(output) for what fails in encoding or writing.
void write_image(const std::filesystem::path& path, const Image& image, const OutputSettings& settings,
                 std::span<const AovImage> aovs = {});

/// Reads any image that OpenImageIO knows into 3 channels: R, G and B if it names them, else the first
/// three; one channel is replicated. Values as stored, 8-bit code v as v/255, no transfer function.
/// Throws Error(scene) for a file that is missing, damaged, unknown or not regular, larger than 65536x65536
/// or not believable in what it claims to hold, and where nothing can be decoded, Error(memory) for one that
/// does not fit into this machine's memory. A file made to attack the decoders may crash them: see
/// read_untrusted_image.
Image read_image(const std::filesystem::path& path);

/// The same for a file from anywhere: it is decoded in a child process of limited memory and processor
/// time, whose crash becomes an Error(scene). For a process without busy threads (see run_in_child).
Image read_untrusted_image(const std::filesystem::path& path);

}  // namespace sahl
