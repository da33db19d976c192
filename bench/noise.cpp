#include "bench/noise.h"

#include <glm/common.hpp>

namespace sahl::bench {
namespace {

/// The output function of PCG. Source: O'Neill 2014, "PCG", sec. 6.3 (RXS-M-XS).
std::uint32_t scramble(std::uint32_t x) {
    x = x * 747796405U + 2891336453U;
    x = ((x >> ((x >> 28U) + 4U)) ^ x) * 277803737U;
    return x >> 22U ^ x;
}

/// The product of `offset` with one of the twelve gradients, which point from a cube's centre to its edges.
float gradient_product(glm::ivec3 corner, glm::vec3 offset) {
    const auto x = static_cast<std::uint32_t>(corner.x), y = static_cast<std::uint32_t>(corner.y),
               z = static_cast<std::uint32_t>(corner.z);
    const std::uint32_t edge = scramble(x ^ scramble(y ^ scramble(z))) % 12U;
    const std::uint32_t across = edge / 4U;
    const float a = offset[across == 0U ? 1 : 0], b = offset[across == 2U ? 1 : 2];
    return ((edge & 1U) != 0U ? -a : a) + ((edge & 2U) != 0U ? -b : b);
}

}  // namespace

float uniform(std::uint32_t index, std::uint32_t dimension) {
    return static_cast<float>(scramble(index ^ scramble(dimension)) >> 8U) * 0x1p-24F;
}

float gradient_noise(glm::vec3 p) {
    const glm::vec3 cell = glm::floor(p);
    const glm::vec3 in_cell = p - cell;
    const glm::vec3 weight = in_cell * in_cell * in_cell * (in_cell * (in_cell * 6.0F - 15.0F) + 10.0F);
    const auto at = [&](int x, int y, int z) {
        return gradient_product(glm::ivec3(cell) + glm::ivec3(x, y, z), in_cell - glm::vec3(x, y, z));
    };
    const auto along_x = [&](int y, int z) { return glm::mix(at(0, y, z), at(1, y, z), weight.x); };
    const auto along_y = [&](int z) { return glm::mix(along_x(0, z), along_x(1, z), weight.y); };
    return glm::mix(along_y(0), along_y(1), weight.z);
}

float fractal_noise(glm::vec3 p, int octaves) {
    float sum = 0;
    float amplitude = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradient_noise(p);
        // Not quite twice, and shifted: the zeros of the octaves must not coincide.
        p = p * 2.03F + glm::vec3(31.7F, 11.3F, 5.9F);
        amplitude *= 0.5F;
    }
    return sum;
}

}  // namespace sahl::bench
