#include "engine/film/transfer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace sahl {
namespace {

template <typename Code>
Code code_of(float value, Transfer transfer, Rounding rounding = Rounding::round, float exposure = 0) {
    Code code = 77;
    quantize(std::span(&value, 1), exposure, transfer, rounding, std::span(&code, 1));
    return code;
}

/// Inverse of the curve in IEC 61966-2-1, which the engine does not have.
double linear_from_srgb(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

template <typename Code>
void check_edges() {
    constexpr int max = std::numeric_limits<Code>::max();
    for (int k = 1; k <= max; k += max / 255) {
        // Floats on either side of k/max and of (k - 1/2)/max; products are exact in long double.
        float value = static_cast<float>(k) / static_cast<float>(max);
        for (const float x : {std::nextafter(value, 0.0F), value, std::nextafter(value, 1.0F)}) {
            const bool reached = static_cast<long double>(x) * max >= k;
            REQUIRE(code_of<Code>(x, Transfer::linear, Rounding::floor) == (reached ? k : k - 1));
            REQUIRE(code_of<Code>(x, Transfer::linear, Rounding::round) == k);
        }
        value = static_cast<float>((k - 0.5) / max);
        for (const float x : {std::nextafter(value, 0.0F), value, std::nextafter(value, 1.0F)}) {
            const bool reached = static_cast<long double>(x) * 2 * max >= 2 * k - 1;
            REQUIRE(code_of<Code>(x, Transfer::linear, Rounding::round) == (reached ? k : k - 1));
            REQUIRE(code_of<Code>(x, Transfer::linear, Rounding::floor) == k - 1);
        }
    }
}

}  // namespace

TEST_CASE("transfer: the sRGB curve in closed form", "[transfer]") {
    CHECK(srgb_from_linear(0) == 0);
    CHECK(srgb_from_linear(0.001) == Approx(0.01292).epsilon(1e-15));
    CHECK(srgb_from_linear(1) == 1);
    CHECK(srgb_from_linear(0.5) == Approx(0.7353569830524495).epsilon(1e-12));
    CHECK(srgb_from_linear(0.0031308) == Approx(srgb_from_linear(0.00313081)).margin(2e-7));
    for (double stored = 0; stored <= 1; stored += 1.0 / 1024)
        CHECK(srgb_from_linear(linear_from_srgb(stored)) == Approx(stored).margin(1e-7));
}

TEST_CASE("transfer: every code comes back through the inverse curve", "[transfer]") {
    for (int k = 0; k <= 255; ++k) {
        REQUIRE(code_of<std::uint8_t>(static_cast<float>(linear_from_srgb(k / 255.0)), Transfer::srgb) == k);
        REQUIRE(code_of<std::uint8_t>(static_cast<float>(k / 255.0), Transfer::linear) == k);
    }
    for (int k = 0; k <= 65535; ++k) {
        REQUIRE(code_of<std::uint16_t>(static_cast<float>(linear_from_srgb(k / 65535.0)), Transfer::srgb) ==
                k);
        REQUIRE(code_of<std::uint16_t>(static_cast<float>(k / 65535.0), Transfer::linear) == k);
    }
}

TEST_CASE("transfer: 8-bit sRGB codes are those of the curve for all values", "[transfer]") {
    for (const Rounding rounding : {Rounding::round, Rounding::floor}) {
        const double offset = rounding == Rounding::round ? 0.5 : 0.0;
        for (float value = 1e-6F; value < 1; value *= 1.00001F)
            REQUIRE(code_of<std::uint8_t>(value, Transfer::srgb, rounding) ==
                    std::floor(srgb_from_linear(value) * 255 + offset));
        for (int k = 1; k <= 255; ++k) {  // around each step of the code
            auto value = static_cast<float>(linear_from_srgb((k - offset) / 255));
            for (int i = 0; i < 10; ++i) value = std::nextafter(value, 0.0F);
            for (int i = 0; i < 20; ++i, value = std::nextafter(value, 2.0F))
                REQUIRE(code_of<std::uint8_t>(value, Transfer::srgb, rounding) ==
                        std::floor(std::min(srgb_from_linear(value), 1.0) * 255 + offset));
        }
    }
}

TEST_CASE("transfer: round and floor change code exactly at their edges", "[transfer]") {
    check_edges<std::uint8_t>();
    check_edges<std::uint16_t>();
}

TEST_CASE("transfer: what is outside [0, 1] is clamped, NaN is 0", "[transfer]") {
    constexpr float inf = std::numeric_limits<float>::infinity();
    for (const Transfer transfer : {Transfer::srgb, Transfer::linear})
        for (const Rounding rounding : {Rounding::round, Rounding::floor}) {
            for (const float black : {0.0F, -0.0F, -1e-30F, -5.0F, -inf, std::nanf("")}) {
                CHECK(+code_of<std::uint8_t>(black, transfer, rounding) == 0);
                CHECK(code_of<std::uint16_t>(black, transfer, rounding) == 0);
            }
            for (const float white : {1.0F, 1.5F, 1e30F, inf}) {
                CHECK(+code_of<std::uint8_t>(white, transfer, rounding) == 255);
                CHECK(code_of<std::uint16_t>(white, transfer, rounding) == 65535);
            }
        }
}

TEST_CASE("transfer: exposure multiplies by a power of two before the curve", "[transfer]") {
    for (float value = 0.001F; value < 0.12F; value *= 1.1F) {
        CHECK(code_of<std::uint16_t>(value, Transfer::srgb, Rounding::round, 3) ==
              code_of<std::uint16_t>(8 * value, Transfer::srgb));
        CHECK(code_of<std::uint8_t>(value, Transfer::linear, Rounding::floor, -1) ==
              code_of<std::uint8_t>(value / 2, Transfer::linear, Rounding::floor));
    }
    CHECK(code_of<std::uint8_t>(0.5F, Transfer::linear, Rounding::round, 0.5F) == 180);  // 255 / sqrt(2)
}

TEST_CASE("transfer: floats are exposed and stay finite", "[transfer]") {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> values{0.1F, -0.3F, 70000, -70000, inf, -inf, std::nanf("")};
    expose(values, 0, -65504, 65504);
    const float max = std::numeric_limits<float>::max();
    CHECK(values == std::vector<float>{0.1F, -0.3F, 65504, -65504, 65504, -65504, 0});
    values = {0.1F, 3e38F, -0.1F};
    expose(values, 2, 0, max);
    CHECK(values == std::vector<float>{0.4F, max, 0});
}

}  // namespace sahl
