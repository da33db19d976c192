// kernels/simd.h: the comparison masks of all code paths, and lane numbers.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

constexpr const char* kSimdKernels = R"(
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
kernel void groups(const global float* a, const global float* b, global uint* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        float16 x = vload16(i, a), y = vload16(i, b);
        int16 m = as_int16(x), n = as_int16(y);
        global uint* to = out + 42u * i;
        Lanes16 less = less16(x, y);
        to[0] = bits16(equal16(x, y));
        to[1] = bits16(less);
        to[2] = bits16(less_equal16(x, y));
        to[3] = bits16(equal16(m, n));
        to[4] = bits16(less16(m, n));
        to[5] = bits16(not16(less)) & 0xffffu;
        to[6] = any16(less);
        to[7] = bits16(lanes16(bits16(less)));
        to[8] = as_uint(least16(fabs(x)));
        to[9] = as_uint(greatest16(fabs(x)));
        vstore16(as_uint16(select16(less, x, y)), 0, to + 10);
        vstore16(as_uint16(select16(less, m, n)), 0, to + 26);
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
        KernelRunner runner(kSimdKernels, option);
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

TEST_CASE("lanes of sixteen rays are compared, chosen and reduced as one by one, on every code path") {
    std::vector<float> a, b;
    fill(a, b);
    const std::size_t count = a.size() / 16, words = 42;
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kSimdKernels, option);
        Buffer out(runner.device(), words * count * sizeof(std::uint32_t), "groups");
        runner.run("groups", count, runner.upload(a), runner.upload(b), out);
        const auto got = KernelRunner::download<std::uint32_t>(out, words * count);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t wanted[8] = {};
            float least = std::numeric_limits<float>::infinity(), greatest = 0;
            bool ordered = true;
            for (std::uint32_t lane = 0; lane < 16; ++lane) {
                const float x = a[16 * i + lane], y = b[16 * i + lane];
                const auto m = std::bit_cast<std::int32_t>(x), n = std::bit_cast<std::int32_t>(y);
                wanted[0] |= static_cast<std::uint32_t>(x == y) << lane;
                wanted[1] |= static_cast<std::uint32_t>(x < y) << lane;
                wanted[2] |= static_cast<std::uint32_t>(x <= y) << lane;
                wanted[3] |= static_cast<std::uint32_t>(m == n) << lane;
                wanted[4] |= static_cast<std::uint32_t>(m < n) << lane;
                REQUIRE(got[words * i + 10 + lane] == bits(x < y ? x : y));
                REQUIRE(got[words * i + 26 + lane] == bits(x < y ? x : y));
                least = std::min(least, std::abs(x));
                greatest = std::max(greatest, std::abs(x));
                ordered = ordered && !std::isnan(x);
            }
            wanted[5] = ~wanted[1] & 0xffffU;
            wanted[6] = wanted[1] != 0;
            wanted[7] = wanted[1];
            for (std::size_t k = 0; k < 8; ++k) {
                CAPTURE(i, k);
                REQUIRE(got[words * i + k] == wanted[k]);
            }
            // Which NaN wins is not promised.
            if (!ordered) continue;
            REQUIRE(got[words * i + 8] == bits(least));
            REQUIRE(got[words * i + 9] == bits(greatest));
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
    KernelRunner runner(kSimdKernels);
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
