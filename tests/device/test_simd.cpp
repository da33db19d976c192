// kernels/simd.h: the comparison masks of all code paths, and lane numbers.
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

constexpr const char* kKernels = R"(
#include "kernels/simd.h"
kernel void masks(const global float* a, const global float* b, global uint* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        float16 x = vload16(i, a), y = vload16(i, b);
        out[4 * i] = mask16_le(x, y);
        out[4 * i + 1] = mask16_ge(x, y);
        out[4 * i + 2] = mask8_le(x.lo, y.lo);
        out[4 * i + 3] = mask4(x.s0123 < y.s0123);
    }
}
kernel void lanes(const global uint* mask, global uint* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        for (uint octant = 0; octant < 8u; ++octant) { out[10 * i + octant] = permute_by_octant(mask[i] & 0xffu, octant); }
        out[10 * i + 8] = lowest_lane(mask[i]);
        out[10 * i + 9] = highest_lane(mask[i]);
    }
}
)";

/// Every pair of awkward values in every lane, and random ones.
void fill(std::vector<float>& a, std::vector<float>& b) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> values{0,
                                    -0.0f,
                                    1,
                                    -1,
                                    0x1p-126f,
                                    -0x1p-126f,
                                    infinity,
                                    -infinity,
                                    nan,
                                    -nan,
                                    std::numeric_limits<float>::max()};
    std::mt19937 random(4);
    for (int round = 0; round < 400; ++round) {
        for (std::size_t lane = 0; lane < 16; ++lane) {
            const std::size_t pair = static_cast<std::size_t>(round) + 13 * lane;
            a.push_back(values[pair % values.size()]);
            b.push_back(values[pair / values.size() % values.size()]);
            if (round >= 300) {
                a.back() = static_cast<float>(random() % 8);
                b.back() = static_cast<float>(random() % 8);
            }
        }
    }
}

}  // namespace

TEST_CASE("masks are the comparisons, lane by lane, on every code path") {
    std::vector<float> a, b;
    fill(a, b);
    // A vector of 16 floats for each index: the first array sets the count.
    const std::size_t count = a.size() / 16;
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kKernels, option);
        Buffer out(runner.device(), 4 * count * sizeof(std::uint32_t), "masks");
        runner.run("masks", count, runner.upload(a), runner.upload(b), out);
        const auto got = KernelRunner::download<std::uint32_t>(out, 4 * count);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t le = 0, ge = 0, lt = 0;
            for (std::uint32_t lane = 0; lane < 16; ++lane) {
                const float x = a[16 * i + lane], y = b[16 * i + lane];
                le |= static_cast<std::uint32_t>(x <= y) << lane;
                ge |= static_cast<std::uint32_t>(x >= y) << lane;
                lt |= static_cast<std::uint32_t>(x < y) << lane;
            }
            REQUIRE(got[4 * i] == le);
            REQUIRE(got[4 * i + 1] == ge);
            REQUIRE(got[4 * i + 2] == (le & 0xffU));
            REQUIRE(got[4 * i + 3] == (lt & 0xfU));
        }
    }
}

TEST_CASE("octants permute the bits of all masks, and lanes are numbered from the lowest bit") {
    std::vector<std::uint32_t> masks;
    for (std::uint32_t mask = 1; mask < 256; ++mask) masks.push_back(mask);
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        masks.push_back(1U << bit);
        masks.push_back(0x80000000U | 1U << bit);
        masks.push_back(1U << bit | (1U << bit) - 1U);
    }
    KernelRunner runner(kKernels);
    const auto got = runner.map<std::uint32_t>("lanes", 10, masks);
    for (std::size_t i = 0; i < masks.size(); ++i) {
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            std::uint32_t moved = 0;
            for (std::uint32_t slot = 0; slot < 8; ++slot)
                moved |= (masks[i] >> slot & 1U) << (slot ^ octant);
            REQUIRE(got[10 * i + octant] == moved);
        }
        std::uint32_t lowest = 0, highest = 31;
        while (!(masks[i] >> lowest & 1U)) ++lowest;
        while (!(masks[i] >> highest & 1U)) --highest;
        REQUIRE(got[10 * i + 8] == lowest);
        REQUIRE(got[10 * i + 9] == highest);
    }
}

}  // namespace sahl::tests
