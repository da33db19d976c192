#include "engine/film/image_compare.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace sahl {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Image filled(int width, int height, float value) {
    const auto count = static_cast<std::size_t>(3 * width * height);
    return {.width = width, .height = height, .channels = 3, .pixels = std::vector<float>(count, value)};
}

float& at(Image& image, int x, int y, int channel) {
    return image.pixels[static_cast<std::size_t>(3 * (y * image.width + x) + channel)];
}

ExitCode code_of(const Image& a, const Image& b, const Image* mask) {
    try {
        compare(a, b, 0, mask);
    } catch (const Error& error) {
        return error.code();
    }
    return ExitCode::ok;
}

}  // namespace

TEST_CASE("compare: equal images", "[compare]") {
    const Image a = filled(5, 4, 0.3F);
    const Comparison result = compare(a, a, 0);
    CHECK(result.max_difference == 0);
    CHECK(result.mean_difference == 0);
    CHECK(result.mse == 0);
    CHECK(result.psnr == infinity);
    CHECK((result.pixels == 20));
    CHECK(result.pixels_over == 0);
}

TEST_CASE("compare: a constant difference in closed form", "[compare]") {
    const Comparison result = compare(filled(5, 4, 0.75F), filled(5, 4, 0.5F), 0.2F);
    CHECK(result.max_difference == 0.25);
    CHECK(result.mean_difference == 0.25);
    CHECK(result.mse == 0.0625);
    CHECK(result.psnr == Approx(20 * std::log10(4.0)));
    CHECK(result.pixels_over == 20);
    CHECK(compare(filled(5, 4, 0.5F), filled(5, 4, 0.75F), 0.25F).pixels_over == 0);
}

TEST_CASE("compare: a pixel counts by its largest channel, the mean over all", "[compare]") {
    const Image a = filled(4, 2, 0);
    Image b = a;
    at(b, 2, 1, 0) = 0.5F;
    at(b, 2, 1, 2) = -1;
    at(b, 3, 1, 1) = 1;
    at(b, 0, 0, 1) = 0.125F;
    const Comparison result = compare(a, b, 0.25F);
    CHECK(result.max_difference == 1);
    CHECK(result.worst_x == 2);
    CHECK(result.worst_y == 1);
    CHECK(result.pixels_over == 2);
    CHECK(result.mean_difference == Approx(2.625 / 24));
    CHECK(result.mse == Approx((0.25 + 1 + 1 + 0.015625) / 24));
    CHECK(compare(a, b, 0).pixels_over == 3);
}

TEST_CASE("compare: thresholds in 8-bit and 16-bit steps", "[compare]") {
    for (const int max : {255, 65535})
        for (int k = 0; k + 3 <= max; k += max / 85) {
            const auto code = [&](int c) {
                return filled(1, 1, static_cast<float>(c) / static_cast<float>(max));
            };
            const float threshold = 2.0F / static_cast<float>(max);
            REQUIRE(compare(code(k), code(k + 2), threshold).pixels_over == 0);
            REQUIRE(compare(code(k), code(k + 3), threshold).pixels_over == 1);
            REQUIRE(compare(code(k), code(k + 1), 0).pixels_over == 1);
        }
    const float next = std::nextafter(0.5F, 1.0F);
    CHECK(compare(filled(1, 1, 0.5F), filled(1, 1, next), 0).pixels_over == 1);
}

TEST_CASE("compare: NaN and infinity are over every threshold", "[compare]") {
    for (const float odd : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        const Image a = filled(2, 2, 0);
        Image b = a;
        at(b, 1, 0, 2) = odd;
        for (const Comparison& result : {compare(a, b, 1e30F), compare(b, a, 1e30F), compare(b, b, 1e30F)}) {
            CHECK(result.pixels_over == 1);
            CHECK(result.max_difference == infinity);
            CHECK(result.mse == infinity);
            CHECK(result.psnr == -infinity);
            CHECK(result.worst_x == 1);
        }
    }
}

TEST_CASE("compare: only white pixels of the mask count", "[compare]") {
    const Image a = filled(3, 1, 0);
    Image b = a;
    at(b, 0, 0, 0) = 1;
    at(b, 1, 0, 0) = 0.5F;
    Image mask = filled(3, 1, 0);
    for (int c = 0; c < 3; ++c) at(mask, 1, 0, c) = at(mask, 2, 0, c) = 1;
    const Comparison result = compare(a, b, 0.1F, &mask);
    CHECK((result.pixels == 2));
    CHECK(result.pixels_over == 1);
    CHECK(result.max_difference == 0.5);
    CHECK(result.mean_difference == Approx(0.5 / 6));
    CHECK(result.worst_x == 1);

    mask = filled(3, 1, 0.5F);
    CHECK(code_of(a, b, &mask) == ExitCode::usage);
    mask = filled(1, 3, 1);
    CHECK(code_of(a, b, &mask) == ExitCode::usage);
}

TEST_CASE("compare: other sizes are a difference", "[compare]") {
    CHECK(code_of(filled(2, 3, 0), filled(3, 2, 0), nullptr) == ExitCode::compare_failed);
    CHECK_THROWS_WITH(difference_image(filled(2, 3, 0), filled(3, 2, 0)),
                      Catch::Contains("2x3") && Catch::Contains("3x2"));
}

TEST_CASE("compare: the difference image", "[compare]") {
    const Image a = filled(2, 1, 0.25F);
    Image b = filled(2, 1, 1);
    at(b, 1, 0, 0) = 0.125F;
    at(b, 1, 0, 2) = std::nanf("");
    const Image difference = difference_image(a, b);
    CHECK(difference.width == 2);
    CHECK(difference.pixels ==
          std::vector<float>{0.75F, 0.75F, 0.75F, 0.125F, 0.75F, std::numeric_limits<float>::infinity()});
}

}  // namespace sahl
