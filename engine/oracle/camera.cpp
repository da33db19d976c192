#include "engine/oracle/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace sahl::oracle {
namespace {

using glm::dvec3;

/// The first word that Philox makes of a counter.
std::uint32_t random_word(std::uint32_t pixel, std::uint32_t sample, std::uint32_t spp,
                          std::uint32_t dimension, std::uint64_t seed) {
    std::uint32_t c[4] = {pixel, sample, spp, dimension};
    auto key0 = static_cast<std::uint32_t>(seed);
    auto key1 = static_cast<std::uint32_t>(seed >> 32U);
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t first = std::uint64_t{0xd2511f53} * c[0];
        const std::uint64_t second = std::uint64_t{0xcd9e8d57} * c[2];
        c[0] = static_cast<std::uint32_t>(second >> 32U) ^ c[1] ^ key0;
        c[1] = static_cast<std::uint32_t>(second);
        c[2] = static_cast<std::uint32_t>(first >> 32U) ^ c[3] ^ key1;
        c[3] = static_cast<std::uint32_t>(first);
        key0 += 0x9e3779b9;
        key1 += 0xbb67ae85;
    }
    return c[0];
}

/// The upper 24 bits as a fraction.
double fraction(std::uint32_t bits) { return (bits >> 8U) / 16777216.0; }

/// i's binary digits behind the point in reverse order.
std::uint32_t van_der_corput(std::uint32_t i) {
    std::uint32_t reversed = 0;
    for (unsigned bit = 0; bit < 32; ++bit) reversed |= (i >> bit & 1U) << (31U - bit);
    return reversed;
}

}  // namespace

Ray camera_ray(const Camera& camera, Resolution resolution, double x, double y) {
    const dvec3 backward = glm::normalize(camera.eye - camera.look_at);
    const dvec3 right = glm::normalize(glm::cross(camera.up, backward));
    const dvec3 up = glm::cross(backward, right);
    const double width = resolution.width;
    const double height = resolution.height;
    const double half_height = std::tan(glm::radians(camera.fov_y) / 2);
    const double half_width = half_height * width / height;
    return {camera.eye, glm::normalize(half_width * (2 * x / width - 1) * right +
                                       half_height * (1 - 2 * y / height) * up - backward)};
}

glm::dvec2 pixel_sample(std::uint32_t x, std::uint32_t y, std::uint32_t i, std::uint32_t spp,
                        std::uint64_t seed) {
    if (spp == 1) return {0.5, 0.5};
    const std::uint32_t pixel = x | y << 16U;
    const std::uint32_t scramble = random_word(pixel, 0, spp, 0, seed);
    const double jitter = fraction(random_word(pixel, i, spp, 1, seed));
    return {fraction(van_der_corput(i) ^ scramble), (i + jitter) / spp};
}

}  // namespace sahl::oracle
