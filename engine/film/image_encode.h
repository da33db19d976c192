// An image file's bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/film/image_format.h"

namespace sahl {

/// What encode() takes beside its arguments, at most: the file and the bands on their way into it.
std::uint64_t encoder_bytes(const Encoding& encoding, int width, int height, std::span<const Aov> aovs);

/// `image` with `aovs` as write_image stores them, converted and encoded a band of rows at a time.
/// `path` is for messages. Throws Error(output) for what fails, Error(usage) for AOVs that the format
/// has no room for.
std::vector<unsigned char> encode(const std::filesystem::path& path, const Image& image,
                                  std::span<const AovImage> aovs, const Encoding& encoding,
                                  const OutputSettings& settings);

}  // namespace sahl
