// From linear colour to what an image file stores: exposure, transfer function, quantisation.
#pragma once

#include <cstdint>
#include <span>

namespace sahl {

/// `srgb`: the piecewise curve of IEC 61966-2-1. `linear`: the value itself.
enum class Transfer { srgb, linear };

/// How v in [0, 1] becomes an integer: `round` is floor(v max + 1/2), `floor` is floor(v max).
enum class Rounding { round, floor };

/// The sRGB value of linear `value` >= 0, computed in double precision.
double srgb_from_linear(double value);

/// Values to integers 0..max (255 or 65535): multiplied by 2^`exposure`, clamped to [0, 1], NaN
/// to 0, then transfer and rounding, all in double precision. `codes` is as long as `values`.
void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint8_t> codes);
void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint16_t> codes);

/// In place: multiplies by 2^`exposure`, NaN to 0, and clamps to [lowest, highest], infinities too.
void expose(std::span<float> values, float exposure, float lowest, float highest);

}  // namespace sahl
