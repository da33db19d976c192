#include "engine/profile/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sahl {
namespace {

constexpr double below_top = 0.995;

std::uint32_t top_of(std::span<const std::uint32_t> counts) {
    if (counts.empty()) return 1;
    std::vector<std::uint32_t> sorted(counts.begin(), counts.end());
    const auto place =
        static_cast<std::ptrdiff_t>(std::ceil(below_top * static_cast<double>(sorted.size() - 1)));
    std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end());
    return std::max(1U, sorted[static_cast<std::size_t>(place)]);
}

/// The inverse of srgb_from_linear().
double linear_from_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace

HeatMap heat_map(std::span<const std::uint32_t> counts, int width, int height) {
    HeatMap map{{width, height, 3, {}}, top_of(counts)};
    map.image.pixels.reserve(3 * counts.size());
    for (const std::uint32_t count : counts) {
        const double at = static_cast<double>(std::min(count, map.top)) / map.top * (heat_colors.size() - 1);
        const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), heat_colors.size() - 2);
        const double part = at - static_cast<double>(below);
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = heat_colors[below][c] * (1 - part) + heat_colors[below + 1][c] * part;
            map.image.pixels.push_back(static_cast<float>(linear_from_srgb(value / 255)));
        }
    }
    return map;
}

}  // namespace sahl
