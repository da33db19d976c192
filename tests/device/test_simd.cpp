// kernels/simd.h: the comparison masks of all code paths, and lane numbers.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
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
// Array k of `out` is that of a result of all lanes.
kernel void groups(const global float* a, const global float* b, global uint* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        for (uint first = 16u * i; first < 16u * (i + 1u); first += SAHL_GROUP_RAYS) {
            floatg x = vloadg(0, a + first), y = vloadg(0, b + first);
            intg m = as_intg(x), n = as_intg(y), yes = 1, no = 0;
            LaneMask less = lessg(x, y);
            uintg of[13] = {
                as_uintg(selectg(equalg(x, y), yes, no)), as_uintg(selectg(less, yes, no)),
                as_uintg(selectg(less_equalg(x, y), yes, no)), as_uintg(selectg(equalg(m, n), yes, no)),
                as_uintg(selectg(lessg(m, n), yes, no)), as_uintg(selectg(notg(less), yes, no)),
                as_uintg(selectg(less, x, y)), as_uintg(selectg(less, m, n)), (uintg)((uint)anyg(less)),
                (uintg)(as_uint(leastg(fabs(x)))), (uintg)(as_uint(greatestg(fabs(x)))),
                (uintg)((uint)SAHL_GROUP_RAYS), (uintg)(bitsg(less))};
            for (uint k = 0; k < 13u; ++k) { vstoreg(of[k], 0, out + 16u * k * count + first); }
        }
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

TEST_CASE("lanes of groups of rays are compared, chosen and reduced as one by one, on every code path") {
    std::vector<float> a, b;
    fill(a, b);
    const std::size_t lanes = a.size(), results = 13;
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kSimdKernels, option);
        Buffer out(runner.device(), results * lanes * sizeof(std::uint32_t), "groups");
        runner.run("groups", lanes / 16, runner.upload(a), runner.upload(b), out);
        const auto got = KernelRunner::download<std::uint32_t>(out, results * lanes);
        const std::size_t width = got[11 * lanes];
        REQUIRE((width == 8 || width == 16));
        for (std::size_t group = 0; group < lanes; group += width) {
            float least = std::numeric_limits<float>::infinity(), greatest = 0;
            bool ordered = true;
            std::uint32_t bits_below = 0;
            for (std::size_t i = group; i < group + width; ++i) {
                const float x = a[i], y = b[i];
                const auto m = std::bit_cast<std::int32_t>(x), n = std::bit_cast<std::int32_t>(y);
                const std::uint32_t wanted[] = {
                    x == y, x < y, x <= y, m == n, m < n, !(x < y), bits(x < y ? x : y), bits(x < y ? x : y)};
                for (std::size_t k = 0; k < std::size(wanted); ++k) {
                    CAPTURE(i, k, x, y);
                    REQUIRE(got[k * lanes + i] == wanted[k]);
                }
                least = std::min(least, std::abs(x));
                greatest = std::max(greatest, std::abs(x));
                ordered = ordered && !std::isnan(x);
                bits_below |= static_cast<std::uint32_t>(x < y) << (i - group);
            }
            CAPTURE(group);
            REQUIRE(got[8 * lanes + group] == (bits_below != 0));
            REQUIRE(got[12 * lanes + group] == bits_below);
            // Which NaN wins is not promised.
            if (!ordered) continue;
            REQUIRE(got[9 * lanes + group] == bits(least));
            REQUIRE(got[10 * lanes + group] == bits(greatest));
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
