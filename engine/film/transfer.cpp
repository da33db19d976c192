#include "engine/film/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sahl {
namespace {

template <typename Code>
void quantize_to(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
                 std::span<Code> codes) {
    const double scale = std::exp2(exposure);
    const double max = std::numeric_limits<Code>::max();
    const double offset = rounding == Rounding::round ? 0.5 : 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        // A NaN fails the comparison and becomes 0.
        const double exposed = scale * values[i];
        const double linear = exposed > 0 ? std::min(exposed, 1.0) : 0.0;
        const double stored = transfer == Transfer::srgb ? srgb_from_linear(linear) : linear;
        codes[i] = static_cast<Code>(stored * max + offset);
    }
}

}  // namespace

double srgb_from_linear(double value) {
    if (value <= 0.0031308) return 12.92 * value;
    const double power = std::pow(value, 1 / 2.4);
    return power + 0.055 * (power - 1);  // 1.055 power - 0.055, but exactly 1 at 1
}

void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint8_t> codes) {
    quantize_to(values, exposure, transfer, rounding, codes);
}

void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint16_t> codes) {
    quantize_to(values, exposure, transfer, rounding, codes);
}

void expose(std::span<float> values, float exposure, float lowest, float highest) {
    const double scale = std::exp2(exposure);
    for (float& value : values) {
        const double exposed = scale * value;
        value = std::isnan(exposed) ? 0.0F : static_cast<float>(std::clamp<double>(exposed, lowest, highest));
    }
}

}  // namespace sahl
