// kernels/camera.h: the order of a crop's pixels, and the engine's own camera rays against the oracle's.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/oracle/camera.h"
#include "engine/render/camera_constants.h"
#include "kernels/device_types.h"
#include "kernels/rays_per_item.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using Pixel = std::array<std::uint32_t, 2>;

constexpr const char* kKernels = R"(
#include "kernels/generate.cl"
kernel void pixels(const uint width, const uint height, global uint2* out, const uint count) {
    TEST_FOR_EACH(i, count) {
        const PixelPlace place = pixel_place(i, width, height);
        out[i] = (uint2)(place.left + place.column, place.top + place.row);
    }
}
// Of samples first.. of a wave with one a pixel: where they are, and where pixel_place() has their pixels.
kernel void eight_together(const uint width, const uint height, const uint first, global uint2* out,
                   global uint2* wanted, const uint count) {
    const WaveConstants wave = {.count = count, .spp = 1, .crop_width = width, .crop_height = height, .samples = 1};
    TEST_FOR_EACH_GROUP(i, count) {
        const CropPixels pixels = crop_pixels(&wave, first, i);
        for (uint k = 0; k < SAHL_LANES && i + k < count; ++k) {
            const PixelPlace place = pixel_place(first + i + k, width, height);
            out[i + k] = (uint2)(((const uint*)&pixels.x)[k], ((const uint*)&pixels.y)[k]);
            wanted[i + k] = (uint2)(place.left + place.column, place.top + place.row);
        }
    }
}
)";

/// The rays that there has to be room for, generate's last parameter: groups of lanes are written whole.
std::size_t capacity_for(const device::WaveConstants& wave) {
    return (wave.count + SAHL_LANES - 1) / SAHL_LANES * SAHL_LANES;
}

}  // namespace

TEST_CASE("the order of pixels visits each pixel of a crop once, in strips of eight rows") {
    KernelRunner runner(kKernels);
    const std::vector<Pixel> sizes{{1, 1}, {1, 9},    {13, 1},   {17, 13},  {8, 8},
                                   {5, 7}, {3, 1000}, {1000, 3}, {640, 361}};
    for (const auto& [width, height] : sizes) {
        CAPTURE(width, height);
        const std::size_t count = std::size_t{width} * height;
        Buffer out(runner.device(), count * sizeof(Pixel), "pixels");
        runner.run("pixels", count, width, height, out);
        const std::vector<Pixel> order = KernelRunner::download<Pixel>(out, count);
        std::vector<int> visits(count);
        for (std::size_t i = 0; i < count; ++i) {
            REQUIRE((order[i][0] < width && order[i][1] < height));
            ++visits[order[i][1] * width + order[i][0]];
            REQUIRE(order[i][1] / 8 == i / (std::size_t{8} * width));
        }
        CHECK(std::count(visits.begin(), visits.end(), 1) == static_cast<std::ptrdiff_t>(count));
    }
}

TEST_CASE("eight samples together are in the pixels that each has alone") {
    KernelRunner runner(kKernels);
    const std::vector<Pixel> sizes{{4, 8},   {13, 1},   {17, 13}, {8, 8},   {5, 7},
                                   {3, 100}, {1000, 3}, {64, 9},  {12, 10}, {640, 31}};
    for (const auto& [width, height] : sizes) {
        for (const std::uint32_t first : {0U, 1U, 3U, 4U, 5U, 8U, 12U}) {
            CAPTURE(width, height, first);
            const std::size_t count = std::size_t{width} * height - first;
            Buffer out(runner.device(), count * sizeof(Pixel), "pixels");
            Buffer wanted(runner.device(), count * sizeof(Pixel), "pixels one by one");
            runner.run("eight_together", count, width, height, first, out, wanted);
            CHECK(KernelRunner::download<Pixel>(out, count) == KernelRunner::download<Pixel>(wanted, count));
        }
    }
}

TEST_CASE("sixteen pixels that follow each other are a square of the image, eight of them a half of it") {
    KernelRunner runner(kKernels);
    constexpr std::uint32_t width = 20, height = 16;
    Buffer out(runner.device(), width * height * sizeof(Pixel), "pixels");
    runner.run("pixels", width * height, width, height, out);
    const std::vector<Pixel> order = KernelRunner::download<Pixel>(out, width * height);
    for (std::size_t i = 0; i < order.size(); ++i) {
        CAPTURE(i);
        const Pixel square = order[i / 16 * 16];
        REQUIRE(square[0] % 4 == 0);
        REQUIRE(square[1] % 4 == 0);
        CHECK(order[i][0] / 4 == square[0] / 4);
        CHECK(order[i][1] - square[1] == i % 16 / 4);
    }
}

TEST_CASE("camera rays go where the oracle's go") {
    KernelRunner runner(kKernels);
    const std::vector<Camera> cameras{{},
                                      {{1, 2, 3}, {-4, 0.5, 2}, {0.1, 1, 0.2}, 90},
                                      {{1e6, -1e6, 1e5}, {1e6, -1e6, 0}, {1, 1, 0}, 3},
                                      {{0, 0, 1e-3}, {1e-3, 0, 0}, {0, 0, 1}, 170}};
    const Resolution resolution{37, 21};
    const device::WaveConstants wave{0, 0, 37 * 21, 1, 0, 0, 37, 21, 5, 0, 0, 1};
    for (const Camera& camera : cameras) {
        const std::size_t capacity = capacity_for(wave);
        Buffer rays(runner.device(), SAHL_RAY_FLOATS * capacity * 4, "rays");
        Buffer ids(runner.device(), SAHL_RAY_UINTS * capacity * 4, "ids");
        runner.run("generate", capacity, camera_constants(camera, resolution), wave, rays, ids);
        const auto floats = KernelRunner::download<float>(rays, SAHL_RAY_FLOATS * capacity);
        const auto words = KernelRunner::download<std::uint32_t>(ids, SAHL_RAY_UINTS * capacity);
        const auto vector = [&](std::size_t first, std::size_t i) {
            return dvec3(floats[first * capacity + i], floats[(first + 1) * capacity + i],
                         floats[(first + 2) * capacity + i]);
        };
        for (std::size_t i = 0; i < wave.count; ++i) {
            const std::uint32_t pixel = words[SAHL_RAY_PIXEL * capacity + i];
            const oracle::Ray wanted =
                oracle::camera_ray(camera, resolution, pixel % 37 + 0.5, pixel / 37 + 0.5);
            const dvec3 origin = vector(SAHL_RAY_ORIGIN, i), direction = vector(SAHL_RAY_DIRECTION, i);
            REQUIRE(words[SAHL_RAY_EXCLUDE * capacity + i] == SAHL_NO_PRIMITIVE);
            REQUIRE(vector(SAHL_RAY_WEIGHT, i) == dvec3(1));
            REQUIRE(glm::distance(direction, wanted.direction) < 1e-7);
            REQUIRE(glm::distance(origin, wanted.origin) <= 1e-7 * glm::length(wanted.origin));
            // With what the floats lack.
            REQUIRE(glm::distance(direction + vector(SAHL_RAY_DIRECTION_LOW, i), wanted.direction) < 1e-13);
            REQUIRE(glm::distance(origin + vector(SAHL_RAY_ORIGIN_LOW, i), wanted.origin) <=
                    1e-14 * glm::length(wanted.origin));
        }
    }
}

TEST_CASE("a crop and a later part of the samples get the rays of the whole image") {
    KernelRunner runner(kKernels);
    const Camera camera{{1, 2, 3}, {-4, 0.5, 2}, {0, 1, 0}, 60};
    const Resolution resolution{40, 30};
    constexpr std::uint32_t kSpp = 3;
    // Directions by film pixel and sample.
    const auto generate = [&](const device::WaveConstants& wave) {
        const std::size_t capacity = capacity_for(wave);
        Buffer rays(runner.device(), SAHL_RAY_FLOATS * capacity * 4, "rays");
        Buffer ids(runner.device(), SAHL_RAY_UINTS * capacity * 4, "ids");
        runner.run("generate", capacity, camera_constants(camera, resolution), wave, rays, ids);
        const auto floats = KernelRunner::download<float>(rays, SAHL_RAY_FLOATS * capacity);
        const auto words = KernelRunner::download<std::uint32_t>(ids, SAHL_RAY_UINTS * capacity);
        std::vector<std::array<float, 3>> result(std::size_t{wave.crop_width} * wave.crop_height * kSpp);
        for (std::size_t i = 0; i < wave.count; ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                result[words[i] * kSpp + (wave.first_low + i) % kSpp][k] =
                    floats[(SAHL_RAY_DIRECTION + k) * capacity + i];
        }
        return result;
    };
    const auto whole = generate({0, 0, 40 * 30 * kSpp, kSpp, 0, 0, 40, 30, 9, 1, 0, kSpp});
    const auto crop = generate({0, 0, 11 * 13 * kSpp, kSpp, 7, 5, 11, 13, 9, 1, 0, kSpp});
    for (std::size_t y = 0; y < 13; ++y) {
        for (std::size_t i = 0; i < 11 * kSpp; ++i)
            REQUIRE(crop[y * 11 * kSpp + i] == whole[((y + 5) * 40 + 7) * kSpp + i]);
    }
    auto parts = generate({0, 0, 500, kSpp, 0, 0, 40, 30, 9, 1, 0, kSpp});
    const auto rest = generate({500, 0, 40 * 30 * kSpp - 500, kSpp, 0, 0, 40, 30, 9, 1, 0, kSpp});
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i] == std::array<float, 3>{}) parts[i] = rest[i];
    }
    CHECK(parts == whole);
}

TEST_CASE("samples are numbered beyond 32 bits") {
    KernelRunner runner(kKernels);
    // Sample 2^32 of 2^14 a pixel is the first of pixel 2^18: the top left one of strip 32 of 1024 columns.
    const device::WaveConstants wave{0, 1, 10, 16384, 0, 0, 1024, 1024, 0, 0, 0, 16384};
    Buffer rays(runner.device(), SAHL_RAY_FLOATS * capacity_for(wave) * 4, "rays");
    Buffer ids(runner.device(), SAHL_RAY_UINTS * capacity_for(wave) * 4, "ids");
    runner.run("generate", capacity_for(wave), camera_constants({}, {1024, 1024}), wave, rays, ids);
    for (const std::uint32_t pixel : KernelRunner::download<std::uint32_t>(ids, wave.count))
        CHECK(pixel == 256 * 1024);
}

}  // namespace sahl::tests
