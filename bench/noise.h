// Deterministic random numbers and noise.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace sahl::bench {

/// Uniform in [0, 1): number `dimension` of sample `index`.
float uniform(std::uint32_t index, std::uint32_t dimension);

/// Perlin's gradient noise, within ±1, zero at points with whole coordinates.
/// Source: Perlin 2002, "Improving Noise".
float gradient_noise(glm::vec3 p);

/// `octaves` of gradient noise, each of half the amplitude and twice the frequency of the one before.
float fractal_noise(glm::vec3 p, int octaves);

}  // namespace sahl::bench
