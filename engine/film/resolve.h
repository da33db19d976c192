// From the film's sums to colours.
#pragma once

#include <cstdint>
#include <span>

namespace sahl {

/// `sums` of a Film divided by `samples` a pixel; `colors` is as long.
void resolve(std::span<const std::int64_t> sums, int samples, std::span<float> colors);

}  // namespace sahl
