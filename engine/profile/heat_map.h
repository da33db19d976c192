// Counts by pixel as colours: dark where there are few, bright where there are many.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/film/film.h"

namespace sahl {

/// From 0 to the top of the scale, evenly spaced, sRGB 0..255: each brighter than the one before, so that the
/// map reads without its hues, too.
inline constexpr std::array<std::array<std::uint8_t, 3>, 6> heat_colors{
    {{8, 7, 26}, {64, 20, 104}, {150, 38, 104}, {222, 82, 58}, {248, 164, 48}, {252, 250, 190}}};

struct HeatMap {
    Image image;            ///< linear, of heat_colors
    std::uint32_t top = 1;  ///< counts from here on have the last colour: 99.5 % of the pixels are below
};

/// `counts`: row by row. Few pixels may be far above all others, hence the top.
HeatMap heat_map(std::span<const std::uint32_t> counts, int width, int height);

}  // namespace sahl
