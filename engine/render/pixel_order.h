// The order in which a render finishes pixels.
#pragma once

#include <cstdint>

namespace sahl {

/// Pixels are finished in strips of so many rows: SAHL_STRIP_HEIGHT of kernels/camera.h.
inline constexpr int strip_rows = 8;

/// How many rows of an image (or a crop) of `width` and `height`, from the top, are finished once `pixels`
/// pixels are.
constexpr int finished_rows(std::uint64_t pixels, int width, int height) {
    const std::uint64_t strips =
        pixels / (static_cast<std::uint64_t>(strip_rows) * static_cast<std::uint64_t>(width));
    const std::uint64_t rows = strips * strip_rows;
    const bool all = pixels >= static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    return all ? height : static_cast<int>(rows);
}

}  // namespace sahl
