#include "tests/host/accel/boxes.h"

#include <cmath>
#include <utility>

namespace sahl::test {

namespace {

Bounds make_bounds(Spread spread, std::size_t i, std::mt19937& random) {
    const float x = uniform(random);
    const float y = uniform(random);
    const float z = uniform(random);
    const float size = uniform(random);
    const auto rank = static_cast<float>(i);
    switch (spread) {
        case Spread::uniform:
            return cube(x, y, z, 0.05f * size);
        case Spread::clustered: {
            // A thousandth of the width of the scene around each of 16 places.
            const auto cluster = static_cast<float>(i % 16);
            return cube(std::sin(cluster) + 1e-3f * x, std::cos(3 * cluster) + 1e-3f * y,
                        std::sin(7 * cluster) + 1e-3f * z, 1e-4f * size);
        }
        case Spread::plane:
            return {{x, y, 0}, {x + 0.1f * size, y + 0.1f, 0}};
        case Spread::line:
            return {{x, 2, 3}, {x, 2, 3}};
        case Spread::point:
            return {{1, 2, 3}, {1, 2, 3}};
        case Spread::same_box:
            return {{1, 2, 3}, {2, 3, 4}};
        case Spread::concentric:
            return {{-size, -size, -size}, {size, size, size}};
        case Spread::grid:
            return cube(std::floor(4 * x), std::floor(4 * y), std::floor(4 * z), 0.5f);
        case Spread::series: {
            // A cube is 1/64 of the one before and of its distance from the origin: in 32 bins the
            // first is alone in the last, and all the others are in bin 0.
            const std::size_t axis = i % 3;
            const float at = std::ldexp(1.0f, 40 - 6 * static_cast<int>(i / 3 % 22));
            return cube(axis == 0 ? at : 0, axis == 1 ? at : 0, axis == 2 ? at : 0, at / 64);
        }
        case Spread::growing: {
            const float side = std::pow(1.25f, std::fmod(rank, 150.0f));
            return cube(0, 0, 0, side);
        }
        case Spread::far:
            return cube(1e15f * x, -1e15f + 1e8f * y, 1e15f, 1e9f * size);
        case Spread::tiny:
            return cube(1e-42f * x, 1e-40f * y, 1e-36f * z, 1e-44f);
        case Spread::negative_zeros: {
            const auto zero = [&](unsigned bit) { return (random() >> bit & 1u) != 0 ? -0.0f : 0.0f; };
            return {{zero(3), zero(4), zero(5)}, {x, zero(6), size > 0.5f ? z : zero(7)}};
        }
    }
    return {};
}

}  // namespace

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

Bounds cube(float x, float y, float z, float size) { return {{x, y, z}, {x + size, y + size, z + size}}; }

std::vector<BuildPrimitive> make_primitives(Spread spread, std::size_t size, bool mixed, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<BuildPrimitive> primitives(size);
    for (std::size_t i = 0; i < size; ++i) {
        primitives[i].bounds = make_bounds(spread, i, random);
        primitives[i].kind = mixed ? static_cast<std::uint32_t>(random() % 9) : SAHL_KIND_TRIANGLE;
        primitives[i].id = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = size; i > 1; --i) std::swap(primitives[i - 1], primitives[random() % i]);
    return primitives;
}

}  // namespace sahl::test
