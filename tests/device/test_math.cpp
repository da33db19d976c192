// kernels/math.h and power.h against double precision.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

constexpr const char* kMathKernels = R"(
#include "kernels/power.h"
kernel void powers(const global float* x, const global float* n, global float* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        const floatv xs = TEST_LANES(floatv, x, i), ns = TEST_LANES(floatv, n, i);
        const floatv powers = power(xs, ns), logs = log2_positive(where(xs > 0.0f, xs, (floatv)(1.0f)));
        const floatv exps = exp2_bounded(ns);
        for (uint k = 0; k < 8u && i + k < count; ++k) {
            vstore3((float3)(((const float*)&powers)[k], ((const float*)&logs)[k], ((const float*)&exps)[k]),
                    i + k, out);
        }
    }
}
kernel void products(const global float4* in, global float* out, const uint count) {
    TEST_FOR_EACH(i, count) { out[i] = difference_of_products(in[i].xxxx, in[i].yyyy, in[i].zzzz, in[i].wwww).x; }
}
kernel void vectors(const global float4* a, const global float4* b, global float* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        float3 n = normalize3(a[i].xyz);
        float3 c = difference_of_products(a[i].yzxx, b[i].zxyy, a[i].zxyy, b[i].yzxx).xyz;
        vstore3(n, 4u * i, out);
        vstore3(c, 4u * i + 1u, out);
        vstore3(cross3(a[i].xyz, b[i].xyz), 4u * i + 2u, out);
        vstore3((float3)(dot3(a[i].xyz, b[i].xyz), max_abs3(a[i].xyz), is_nonzero(a[i].xyz)), 4u * i + 3u, out);
    }
}
)";

constexpr double kSmallestNormal = 0x1p-126;

struct FloatLanes {
    float x, y, z, w;
};

struct Powers {
    double power, log2, exp2;
};

std::vector<Powers> run_powers(const std::vector<float>& x, const std::vector<float>& n) {
    KernelRunner runner(kMathKernels);
    const std::vector<float> out = runner.map<float>("powers", 3, x, n);
    std::vector<Powers> result;
    for (std::size_t i = 0; i < x.size(); ++i) result.push_back({out[3 * i], out[3 * i + 1], out[3 * i + 2]});
    return result;
}

}  // namespace

TEST_CASE("power, log2 and exp2 are within their stated errors over their domains") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<float> x;
    std::vector<float> n;
    for (int i = 0; i < 200000; ++i) {
        // Cosines over the whole range, crowded at 1 as highlights are, and at 0.
        const double u = unit(random);
        const double base = i % 4 == 0   ? 2 * u
                            : i % 4 == 1 ? 1 - std::exp2(-24 * u)
                            : i % 4 == 2 ? std::exp2(-100 * u)
                                         : 1 + std::exp2(-23 * u);
        x.push_back(static_cast<float>(base));
        const double limit =
            x.back() > 1 ? std::min(127 / std::log2(static_cast<double>(x.back())), 1e5) : 1e5;
        n.push_back(static_cast<float>(limit * 0.9999 * std::pow(unit(random), 6)));
    }
    const std::vector<Powers> got = run_powers(x, n);
    double worst_power = 0, worst_log = 0, worst_exp = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double base = x[i], exponent = n[i];
        const double log = std::log2(base);
        worst_log = std::max(worst_log, std::abs(got[i].log2 - log) / std::abs(log == 0 ? 1 : log));
        if (exponent <= 127) worst_exp = std::max(worst_exp, std::abs(got[i].exp2 / std::exp2(exponent) - 1));
        const double wanted = std::pow(base, exponent);
        if (wanted >= 2 * kSmallestNormal) {
            const double bound = 2e-7 * (1 + exponent * std::abs(log));
            worst_power = std::max(worst_power, std::abs(got[i].power / wanted - 1) / bound);
        } else {
            CHECK(got[i].power <= 2.1 * kSmallestNormal);
            CHECK(got[i].power >= 0);
        }
    }
    CHECK(worst_log < 3e-7);
    CHECK(worst_exp < 2e-7);
    CHECK(worst_power < 1);
}

TEST_CASE("power at the ends of its domain") {
    constexpr float kTiny = 0x1p-126f;
    const std::vector<float> x{0,    0, 0, 1,     1,     1,     0.5f,        0.5f,
                               0.5f, 2, 2, kTiny, kTiny, -0.0f, 0.99999994f, 0.9f};
    const std::vector<float> n{0, 1, 1e5f, 0, 1, 1e5f, 1, 126, 127, 1, 127, 1, 1e5f, 0, 100000, 1e38f};
    const std::vector<double> wanted{1,
                                     0,
                                     0,
                                     1,
                                     1,
                                     1,
                                     0.5,
                                     kSmallestNormal,
                                     0,
                                     2,
                                     0x1p127,
                                     kTiny,
                                     0,
                                     1,
                                     std::pow(static_cast<double>(0.99999994f), 1e5),
                                     0};
    const std::vector<Powers> got = run_powers(x, n);
    for (std::size_t i = 0; i < x.size(); ++i) {
        CAPTURE(x[i], n[i]);
        CHECK(got[i].power == Approx(wanted[i]).epsilon(5e-7));
    }
}

TEST_CASE("exp2 below the normal numbers is 0, and infinite exponents of 0 stay 0") {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> n{-126, -126.0001f, -127, -1000, -1e30f, -infinity, 0, 127, -125.5f};
    const std::vector<double> wanted{kSmallestNormal, 0, 0, 0, 0, 0, 1, 0x1p127, std::exp2(-125.5)};
    const std::vector<Powers> got = run_powers(std::vector<float>(n.size(), 1.0f), n);
    for (std::size_t i = 0; i < n.size(); ++i) {
        CAPTURE(n[i]);
        CHECK(got[i].exp2 == Approx(wanted[i]).epsilon(2e-7));
    }
}

TEST_CASE("differences of products are right to 1.5 ulp however much cancels") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<FloatLanes> in;
    for (int i = 0; i < 100000; ++i) {
        const float a = unit(random), b = unit(random);
        const float nudge = 1 + static_cast<float>(i % 8) * 0x1p-23f;
        in.push_back(i % 2 ? FloatLanes{a, b, unit(random), unit(random)} : FloatLanes{a, b, a * nudge, b});
        if (i % 10 == 0) in.back() = {a, b, b, a};
    }
    in.push_back({3, 4, 2, 6});
    KernelRunner runner(kMathKernels);
    const std::vector<float> got = runner.map<float>("products", 1, in);
    double worst = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
        // 24-bit products are exact in double, their difference in long double.
        const long double wanted =
            static_cast<long double>(in[i].x) * in[i].y - static_cast<long double>(in[i].z) * in[i].w;
        if (wanted == 0) {
            REQUIRE(got[i] == 0);
            continue;
        }
        if (std::abs(static_cast<double>(wanted)) < 0x1p-60) continue;  // the fma's error may underflow
        const double ulp = std::exp2(std::ilogb(static_cast<double>(wanted)) - 23);
        worst = std::max(worst, std::abs(static_cast<double>(got[i] - wanted)) / ulp);
    }
    CHECK(worst <= 1.5);
    CHECK(worst > 0.4);
}

TEST_CASE("vectors: unit lengths, cross and dot products") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<FloatLanes> a{
        {1, 0, 0, 0}, {0, 0, -0.0f, 0}, {3, -4, 0, 0}, {-1e-15f, 0, 0, 0}, {0, 1e15f, 0, 0}};
    std::vector<FloatLanes> b{{0, 1, 0, 0}, {1, 2, 3, 0}, {4, 3, 0, 0}, {0, 1e-15f, 0, 0}, {0, 0, 1e15f, 0}};
    for (int i = 0; i < 20000; ++i) {
        const float scale = std::exp2(40 * unit(random));
        a.push_back({scale * unit(random), scale * unit(random), scale * unit(random), 0});
        b.push_back({unit(random), unit(random), unit(random), 0});
    }
    KernelRunner runner(kMathKernels);
    const std::vector<float> out = runner.map<float>("vectors", 12, a, b);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float* got = &out[12 * i];
        const double ax = a[i].x, ay = a[i].y, az = a[i].z, bx = b[i].x, by = b[i].y, bz = b[i].z;
        const double length = std::sqrt(ax * ax + ay * ay + az * az);
        const double size = length * std::sqrt(bx * bx + by * by + bz * bz);
        const double unit_vector[] = {ax / length, ay / length, az / length};
        const double cross[] = {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
        for (int k = 0; k < 3; ++k) {
            if (length > 0) REQUIRE(std::abs(got[k] - unit_vector[k]) < 3e-7);
            REQUIRE(std::abs(got[3 + k] - cross[k]) <= 1.5 * 0x1p-23 * std::abs(cross[k]));
            REQUIRE(std::abs(got[6 + k] - cross[k]) <= 2 * 0x1p-23 * size);
        }
        REQUIRE(std::abs(got[9] - (ax * bx + ay * by + az * bz)) <= 3 * 0x1p-23 * size);
        REQUIRE(got[10] == std::max({std::abs(a[i].x), std::abs(a[i].y), std::abs(a[i].z)}));
        REQUIRE((got[11] != 0) == (length > 0));
    }
}

}  // namespace sahl::tests
