// An image file's pixels.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/film/film.h"

namespace sahl {

constexpr int max_image_size = 65536;  ///< width and height

/// Decodes as read_image says. `before_pixels` is called with the number of values (3 a pixel) once
/// the header is read and believed, before there is memory for them.
/// Throws as read_image.
Image decode(const std::filesystem::path& path, const std::function<void(std::size_t)>& before_pixels);

/// Error(scene): the image cannot be read because of `cause`.
[[noreturn]] void fail_decoding(const std::filesystem::path& path, std::string cause);

/// Error(memory): the image is too large for this machine.
[[noreturn]] void fail_for_memory(const std::filesystem::path& path);

}  // namespace sahl
