#include "engine/film/transfer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace sahl {
namespace {

template <typename Code>
Code code_of(double linear, Transfer transfer, double offset) {
    const double stored = transfer == Transfer::srgb ? srgb_from_linear(linear) : linear;
    return static_cast<Code>(stored * std::numeric_limits<Code>::max() + offset);
}

/// 8-bit sRGB codes without the power for 97 % of all values: one entry for each interval of
/// doubles in [2^-13, 1] that agree in their first 11 mantissa bits.
class SrgbTable {
public:
    explicit SrgbTable(double offset) : offset_(offset), codes_(index(1.0) + 1) {
        for (std::uint64_t i = 0; i < codes_.size(); ++i) {
            const auto low =
                code_of<std::uint8_t>(std::bit_cast<double>((first + i) << shift), Transfer::srgb, offset);
            const auto high = code_of<std::uint8_t>(std::bit_cast<double>(((first + i + 1) << shift) - 1),
                                                    Transfer::srgb, offset);
            codes_[i] = low == high || i + 1 == codes_.size() ? low : mixed;
        }
    }

    /// `linear` in [0, 1].
    std::uint8_t operator()(double linear) const {
        if (linear >= 0x1p-13) {
            const std::int16_t code = codes_[index(linear)];
            if (code != mixed) return static_cast<std::uint8_t>(code);
        }
        return code_of<std::uint8_t>(linear, Transfer::srgb, offset_);
    }

private:
    static constexpr int shift = 52 - 11;
    static constexpr std::uint64_t first = std::bit_cast<std::uint64_t>(0x1p-13) >> shift;
    static constexpr std::int16_t mixed = -1;

    static std::uint64_t index(double linear) {
        return (std::bit_cast<std::uint64_t>(linear) >> shift) - first;
    }

    double offset_;
    std::vector<std::int16_t> codes_;
};

template <typename Code, typename Encode>
void quantize_by(std::span<const float> values, float exposure, std::span<Code> codes, Encode encode) {
    const double scale = std::exp2(exposure);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double exposed = scale * values[i];
        codes[i] = encode(exposed > 0 ? std::min(exposed, 1.0) : 0.0);  // a NaN is not above 0
    }
}

double offset_of(Rounding rounding) { return rounding == Rounding::round ? 0.5 : 0.0; }

}  // namespace

double srgb_from_linear(double value) {
    if (value <= 0.0031308) return 12.92 * value;
    const double power = std::pow(value, 1 / 2.4);
    return power + 0.055 * (power - 1);  // 1.055 power - 0.055, but exactly 1 at 1
}

void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint8_t> codes) {
    const double offset = offset_of(rounding);
    if (transfer == Transfer::linear)
        return quantize_by(values, exposure, codes, [=](double linear) {
            return code_of<std::uint8_t>(linear, Transfer::linear, offset);
        });
    static const SrgbTable rounded(offset_of(Rounding::round));
    static const SrgbTable floored(offset_of(Rounding::floor));
    const SrgbTable& table = rounding == Rounding::round ? rounded : floored;
    quantize_by(values, exposure, codes, [&](double linear) { return table(linear); });
}

void quantize(std::span<const float> values, float exposure, Transfer transfer, Rounding rounding,
              std::span<std::uint16_t> codes) {
    const double offset = offset_of(rounding);
    quantize_by(values, exposure, codes,
                [=](double linear) { return code_of<std::uint16_t>(linear, transfer, offset); });
}

void expose(std::span<float> values, float exposure, float lowest, float highest) {
    const double scale = std::exp2(exposure);
    for (float& value : values) {
        const double exposed = scale * value;
        value = std::isnan(exposed) ? 0.0F : static_cast<float>(std::clamp<double>(exposed, lowest, highest));
    }
}

}  // namespace sahl
