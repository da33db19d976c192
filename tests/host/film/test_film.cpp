#include "engine/film/film.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cfenv>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "engine/core/error.h"

namespace sahl {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Contribution {
    std::uint32_t pixel;
    float red, green, blue;
};

void add(Film& film, const std::vector<Contribution>& all) {
    std::vector<std::uint32_t> pixels;
    std::vector<float> red, green, blue;
    for (const Contribution& c : all) {
        pixels.push_back(c.pixel);
        red.push_back(c.red);
        green.push_back(c.green);
        blue.push_back(c.blue);
    }
    film.add(pixels, red.data(), green.data(), blue.data());
}

/// What the film holds after `value` alone.
float stored(float value) {
    MemoryAccountant accountant;
    Film film(accountant, 1, 1);
    add(film, {{0, value, 0, 0}});
    return film.resolve(1).pixels[0];
}

/// Floats of all magnitudes up to `largest`, both signs.
std::vector<float> random_floats(std::size_t count, float largest, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> mantissa(0.5F, 1.0F);
    std::uniform_int_distribution<int> exponent(-40, std::ilogb(largest));
    std::vector<float> values(count);
    for (float& value : values)
        value = std::ldexp(mantissa(random), exponent(random)) * ((random() & 1) != 0 ? 1.0F : -1.0F);
    return values;
}

}  // namespace

TEST_CASE("film: merged films hold the sums and counts of both", "[film]") {
    MemoryAccountant accountant;
    Film a(accountant, 2, 1), b(accountant, 2, 1), wider(accountant, 3, 1);
    add(a, {{0, 0.25F, -1, 3}, {1, nan, 200000, 0}});
    add(b, {{0, 0.5F, 1, 0x1p-32F}, {1, 1, inf, 7}});
    a.merge(b);
    const Image image = a.resolve(1);
    CHECK(image.pixels == std::vector<float>{0.75F, 0, 3, 1, 131072, 7});
    CHECK(a.non_finite_count() == 2);
    CHECK(a.clamped_count() == 1);
    CHECK_THROWS_AS(a.merge(wider), Error);
}

TEST_CASE("film: one contribution comes back exactly where Q31.32 holds it", "[film]") {
    for (const float value :
         {0.0F, 1.0F, -1.0F, 0.2F, 1.0F / 3, 131072.0F, -131072.0F, 131071.99F, 0x1p-32F, -0x1p-32F})
        CHECK(stored(value) == value);
    for (const float value : random_floats(2000, 131072, 1))
        if (std::fabs(value) >= 0x1p-9F) REQUIRE(stored(value) == value);
}

TEST_CASE("film: a contribution is rounded to the nearest 2^-32, halves away from zero", "[film]") {
    const float below_half = std::nextafter(0.5F, 0.0F);
    for (const float sign : {1.0F, -1.0F}) {
        CHECK(stored(sign * 0x1p-32F * below_half) == 0);
        CHECK(stored(sign * 0x1p-32F * 0.5F) == sign * 0x1p-32F);
        CHECK(stored(sign * 0x1p-32F * 1.5F) == sign * 0x1p-31F);
        CHECK(stored(sign * 0x1p-32F * 2.5F) == sign * 3 * 0x1p-32F);
        CHECK(stored(sign * std::numeric_limits<float>::denorm_min()) == 0);
    }
    for (const float value : random_floats(20000, 131072, 2))
        REQUIRE(stored(value) ==
                static_cast<float>(std::round(static_cast<double>(value) * 0x1p32) * 0x1p-32));
}

TEST_CASE("film: contributions from 1.2e-5 on keep five digits", "[film]") {
    for (float value = 1.2e-5F; value < 1; value *= 1.37F)
        CHECK(std::fabs(stored(value) - value) <= 1e-5F * value);
}

TEST_CASE("film: the rounding mode does not matter", "[film]") {
    const std::vector<float> values = random_floats(1000, 131072, 3);
    std::vector<Contribution> all;
    for (std::uint32_t i = 0; i < 1000; ++i) all.push_back({i, values[i], -values[i], values[999 - i]});
    const auto pixels = [&](int mode) {
        MemoryAccountant accountant;
        Film film(accountant, 1000, 1);
        std::fesetround(mode);
        add(film, all);
        std::fesetround(FE_TONEAREST);
        return film.resolve(1).pixels;
    };
    const std::vector<float> nearest = pixels(FE_TONEAREST);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) CHECK(pixels(mode) == nearest);
}

TEST_CASE("film: 16384 samples of 6e4 do not saturate", "[film]") {
    MemoryAccountant accountant;
    Film film(accountant, 1, 1);
    const std::vector<Contribution> all(16384, {0, 6e4F, -6e4F, 1e-5F});
    add(film, all);
    const Image image = film.resolve(16384);
    CHECK(image.pixels[0] == 6e4F);
    CHECK(image.pixels[1] == -6e4F);
    CHECK(image.pixels[2] == Approx(1e-5).epsilon(1e-5));
    CHECK(film.clamped_count() == 0);
}

TEST_CASE("film: a sum that leaves the range on the way comes back right", "[film]") {
    MemoryAccountant accountant;
    Film film(accountant, 1, 1);
    add(film, std::vector<Contribution>(20000, {0, 131072, -131072, 1}));
    add(film, std::vector<Contribution>(5000, {0, -131072, 131072, 1}));
    CHECK(film.resolve(1).pixels == std::vector<float>{15000 * 131072.0F, -15000 * 131072.0F, 25000});
}

TEST_CASE("film: non-finite contributions add 0 and are counted, huge ones are clamped and counted",
          "[film]") {
    MemoryAccountant accountant;
    Film film(accountant, 2, 1);
    add(film, {{0, nan, 1, -inf},
               {0, 2, inf, 3},
               {1, 131073, -4e30F, -131072},
               {1, std::nextafter(131072.0F, inf), 0, 0}});
    CHECK(film.resolve(1).pixels == std::vector<float>{2, 1, 3, 262144, -131072, -131072});
    CHECK(film.non_finite_count() == 3);
    CHECK(film.clamped_count() == 3);
    add(film, {{0, std::numeric_limits<float>::max(), -nan, std::numeric_limits<float>::lowest()}});
    CHECK(film.non_finite_count() == 4);
    CHECK(film.clamped_count() == 5);
}

TEST_CASE("film: neither order nor division into calls changes a bit", "[film]") {
    constexpr std::size_t count = 50000;
    std::mt19937 random(4);
    const std::vector<float> values = random_floats(3 * count, 131072, 5);
    std::vector<Contribution> all;
    for (std::size_t i = 0; i < count; ++i)
        all.push_back(
            {static_cast<std::uint32_t>(random() % 64), values[3 * i], values[3 * i + 1], values[3 * i + 2]});

    MemoryAccountant accountant;
    Film whole(accountant, 8, 8);
    add(whole, all);
    const std::vector<float> expected = whole.resolve(7).pixels;
    for (const std::size_t chunk : {1UL, 511UL, 512UL, 513UL, 7777UL}) {
        std::shuffle(all.begin(), all.end(), random);
        Film film(accountant, 8, 8);
        for (std::size_t begin = 0; begin < count; begin += chunk)
            add(film, {all.begin() + static_cast<std::ptrdiff_t>(begin),
                       all.begin() + static_cast<std::ptrdiff_t>(std::min(count, begin + chunk))});
        CHECK(film.resolve(7).pixels == expected);
    }
}

TEST_CASE("film: pixels are row-major with interleaved channels, divided by the samples", "[film]") {
    MemoryAccountant accountant;
    Film film(accountant, 3, 2);
    add(film, {{1, 1, 2, 3}, {5, 4, 5, 6}, {1, 1, 0, 0}});
    const Image image = film.resolve(4);
    CHECK(image.width == 3);
    CHECK(image.height == 2);
    CHECK(image.channels == 3);
    std::vector<float> expected(18, 0.0F);
    expected[3] = 0.5F, expected[4] = 0.5F, expected[5] = 0.75F;
    expected[15] = 1, expected[16] = 1.25F, expected[17] = 1.5F;
    CHECK((image.pixels == expected));
}

TEST_CASE("film: the accountant sees it while it lives", "[film]") {
    MemoryAccountant accountant;
    {
        const Film film(accountant, 512, 512);
        CHECK(accountant.current() >= 24U * 512 * 512);
    }
    CHECK(accountant.current() == 0);
}

TEST_CASE("film: a pixel outside is an internal error and adds nothing", "[film]") {
    MemoryAccountant accountant;
    Film film(accountant, 2, 2);
    try {
        add(film, {{0, 1, 1, 1}, {4, 1, 1, 1}});
        FAIL("not refused");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::internal);
    }
    CHECK(film.resolve(1).pixels == std::vector<float>(12, 0.0F));
    film.add({}, nullptr, nullptr, nullptr);
}

}  // namespace sahl
