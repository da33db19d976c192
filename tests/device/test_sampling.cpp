// kernels/rng.h and kernels/sampling.h: known answers, strata, uniformity.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

constexpr const char* kSamplingKernels = R"(
#include "kernels/sampling.h"
kernel void philox(const global uint4* counter, const global uint2* key, global uint4* out, const uint count) {
    TEST_FOR_EACH(i, count) { out[i] = philox4x32(counter[i], key[i]); }
}
kernel void uniform_floats(const global uint* bits, global float* out, const uint count) {
    TEST_FOR_EACH(i, count) { out[i] = uniform_float(bits[i]); }
}
kernel void samples(const uint x, const uint y, const uint width, const uint spp, const uint2 seed,
                    global float2* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        uint pixel = i / spp;
        out[i] = pixel_sample(x + pixel % width, y + pixel / width, i % spp, spp, seed);
    }
}
)";

using Words = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;
using Point = std::array<float, 2>;

/// All samples of `pixels` pixels, row by row `width` wide, from (x, y) on.
std::vector<Point> samples(KernelRunner& runner, std::uint32_t x, std::uint32_t y, std::uint32_t width,
                           std::uint32_t pixels, std::uint32_t spp, Key seed = {7, 0}) {
    const std::size_t count = std::size_t{pixels} * spp;
    Buffer out(runner.device(), count * sizeof(Point), "samples");
    runner.run("samples", count, x, y, width, spp, seed, out);
    return KernelRunner::download<Point>(out, count);
}

/// Pearson's statistic of `counts` against equal numbers.
double chi_squared(const std::vector<int>& counts) {
    double total = 0;
    for (const int count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size());
    double sum = 0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

/// Chi-squared's 1 - 1e-6 quantile for many degrees of freedom (Wilson, Hilferty 1931).
double chi_squared_limit(double freedom) {
    const double spread = 2 / (9 * freedom);
    return freedom * std::pow(1 - spread + 4.75 * std::sqrt(spread), 3);
}

}  // namespace

TEST_CASE("Philox gives the known answers of its authors") {
    const std::vector<Words> counters{{0, 0, 0, 0},
                                      {0xffffffffU, 0xffffffffU, 0xffffffffU, 0xffffffffU},
                                      {0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}};
    const std::vector<Key> keys{{0, 0}, {0xffffffffU, 0xffffffffU}, {0xa4093822U, 0x299f31d0U}};
    const std::vector<Words> wanted{{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U},
                                    {0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU},
                                    {0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}};
    KernelRunner runner(kSamplingKernels);
    CHECK(runner.map<Words>("philox", 1, counters, keys) == wanted);
}

TEST_CASE("uniform floats are in [0, 1) and as fine as promised") {
    const std::vector<std::uint32_t> bits{0, 0xffU, 0x100U, 0x80000000U, 0xffffffffU};
    const std::vector<float> wanted{0, 0, 0x1p-24f, 0.5f, 0x1.fffffep-1f};
    KernelRunner runner(kSamplingKernels);
    CHECK(runner.map<float>("uniform_floats", 1, bits) == wanted);
}

TEST_CASE("one sample is the pixel's centre") {
    KernelRunner runner(kSamplingKernels);
    for (const Point& point : samples(runner, 3, 65530, 3, 9, 1)) CHECK(point == Point{0.5f, 0.5f});
}

TEST_CASE("samples lie in their strata") {
    KernelRunner runner(kSamplingKernels);
    for (const std::uint32_t spp : {2U, 3U, 4U, 7U, 16U, 60U, 64U, 1000U, 1024U, 16383U, 16384U}) {
        CAPTURE(spp);
        constexpr std::uint32_t kPixels = 6;
        const std::vector<Point> points = samples(runner, 100, 7, 3, kPixels, spp);
        const bool power_of_two = (spp & (spp - 1)) == 0;
        for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
            // For every 2^k x 2^(m-k) grid, the cells that samples fell into.
            std::vector<std::set<std::uint32_t>> cells(15);
            for (std::uint32_t i = 0; i < spp; ++i) {
                const auto [x, y] = points[pixel * spp + i];
                REQUIRE((x >= 0 && x < 1 && y >= 0 && y < 1));
                // Row i, up to the rounding of y.
                const double row = static_cast<double>(y) * spp;
                const double rounding = 0x1p-23 * (i + 1);
                REQUIRE(row >= i - rounding);
                REQUIRE(row <= i + 1 + rounding);
                for (std::uint32_t columns = 1, k = 0; power_of_two && columns <= spp; columns *= 2, ++k) {
                    const std::uint32_t rows = spp / columns;
                    cells[k].insert(static_cast<std::uint32_t>(x * static_cast<float>(columns)) * rows +
                                    i * rows / spp);
                }
            }
            for (std::uint32_t columns = 1, k = 0; power_of_two && columns <= spp; columns *= 2, ++k) {
                CAPTURE(columns);
                REQUIRE(cells[k].size() == spp);
            }
        }
    }
}

TEST_CASE("samples are uniform over many pixels and independent between neighbours") {
    KernelRunner runner(kSamplingKernels);
    constexpr std::uint32_t kSide = 256;
    for (const std::uint32_t spp : {2U, 5U, 8U}) {
        CAPTURE(spp);
        const std::vector<Point> points = samples(runner, 0, 0, kSide, kSide * kSide, spp);
        constexpr int kCells = 16;
        // Sample i of a pixel alone is uniform in x and within its row; so is the pair of the first samples
        // of two neighbours.
        std::vector<int> place(kCells * kCells), pair(kCells * kCells);
        const auto cell = [](double value) { return std::min(static_cast<int>(value * kCells), kCells - 1); };
        for (std::size_t pixel = 0; pixel < kSide * kSide; ++pixel) {
            const std::uint32_t i = static_cast<std::uint32_t>(pixel) % spp;
            const Point& point = points[pixel * spp + i];
            const double in_row = std::max(static_cast<double>(point[1]) * spp - i, 0.0);
            ++place[static_cast<std::size_t>(cell(point[0]) * kCells + cell(in_row))];
            if (pixel % 2 == 0) {
                const Point& next = points[(pixel + 1) * spp];
                ++pair[static_cast<std::size_t>(cell(points[pixel * spp][0]) * kCells + cell(next[0]))];
            }
        }
        CHECK(chi_squared(place) < chi_squared_limit(kCells * kCells - 1));
        CHECK(chi_squared(pair) < chi_squared_limit(kCells * kCells - 1));
    }
}

TEST_CASE("a sample depends on its pixel in the image, the number of samples and the seed alone") {
    KernelRunner runner(kSamplingKernels);
    constexpr std::uint32_t kWidth = 40, kSpp = 4;
    const std::vector<Point> whole = samples(runner, 0, 0, kWidth, kWidth * 30, kSpp);
    // A crop from (11, 9), 13 wide.
    const std::vector<Point> crop = samples(runner, 11, 9, 13, 13 * 17, kSpp);
    for (std::size_t i = 0; i < crop.size(); ++i) {
        const std::size_t pixel = i / kSpp;
        const std::size_t x = 11 + pixel % 13, y = 9 + pixel / 13;
        REQUIRE(crop[i] == whole[(y * kWidth + x) * kSpp + i % kSpp]);
    }
    CHECK(samples(runner, 0, 0, kWidth, kWidth * 30, kSpp, {8, 0}) != whole);
    CHECK(samples(runner, 0, 0, kWidth, kWidth * 30, kSpp, {7, 1}) != whole);
}

}  // namespace sahl::tests
