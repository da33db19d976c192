// How much two images differ.
#pragma once

#include <cstdint>

#include "engine/film/film.h"

namespace sahl {

/// Differences of stored values: for 8-bit files 1 step is 1/255. A NaN or infinity on either side
/// is an infinite difference.
struct Comparison {
    double max_difference = 0;      ///< largest |a - b| of a channel
    double mean_difference = 0;     ///< mean |a - b| over pixels and channels
    double mse = 0;                 ///< mean (a - b)² over pixels and channels
    double psnr = 0;                ///< -10 log10(mse) dB, for a peak of 1; infinite for equal images
    std::uint64_t pixels = 0;       ///< compared: all, or those of the mask
    std::uint64_t pixels_over = 0;  ///< with a channel that differs by more than the threshold
    int worst_x = 0;                ///< where max_difference is, the first in row order
    int worst_y = 0;
};

/// Compares where the red channel of `mask` (none: everywhere) is above 1/2. A threshold above 0
/// has 2^-23 added: 8-bit codes that differ by 2 do not differ by more than 2.0F/255, whatever the
/// quotients' last bits.
/// Throws Error(compare_failed) if the sizes differ, Error(usage) if the mask's size is another or
/// it leaves no pixel.
Comparison compare(const Image& a, const Image& b, float threshold, const Image* mask = nullptr);

/// |a - b| of each channel, infinite where a NaN or infinity is on either side. Throws
/// Error(compare_failed) if the sizes differ.
Image difference_image(const Image& a, const Image& b);

}  // namespace sahl
