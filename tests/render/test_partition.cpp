// What an image may not depend on (batches, crops) and what its samples promise.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "engine/core/error.h"
#include "engine/oracle/build_scene.h"
#include "engine/render/pixel_order.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

using oracle::add_polygon;
using oracle::emitting;

/// Glass balls on a mirror: the ray tree doubles at most generations.
Scene branching_scene() {
    Scene scene;
    scene.cameras[0] = {{0.2, -6, 3}, {0, 0, 0.4}, {0, 0, 1}, 40};
    scene.background = {0.2F, 0.3F, 0.5F};
    scene.lights = {oracle::point_light({3, -4, 5}), oracle::point_light({-4, -1, 3}, {0.4F, 0.3F, 0.2F})};
    Material glass = oracle::glass({0.8F, 0.9F, 0.8F}, 1.3F);
    glass.reflection = glm::vec3(0.2F);
    glass.specular = glm::vec3(0.5F);
    glass.shininess = 20;
    for (int i = 0; i < 9; ++i) oracle::add_sphere(scene, {{i % 3 - 1, i / 3 - 1, 0.5}, 0.45}, glass);
    Material floor = oracle::matte({0.7F, 0.6F, 0.5F});
    floor.reflection = glm::vec3(0.3F);
    oracle::add_square(scene, 0, 8, floor);
    return scene;
}

bool same_counts(const RenderStatistics& a, const RenderStatistics& b) {
    return std::equal(a.generations.begin(), a.generations.end(), b.generations.begin(), b.generations.end(),
                      [](const GenerationCounts& left, const GenerationCounts& right) {
                          return left.rays == right.rays && left.shadow_rays == right.shadow_rays;
                      });
}

TEST_CASE("render: the ray budget changes no bit", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings = square_settings(40, 5);
    settings.spp = 2;
    settings.ray_budget = 1U << 22U;
    const Rendered whole = render(renderer, settings);
    CHECK(whole.statistics.generations.back().rays > 100);
    for (const std::uint32_t budget : {64U, 65U, 1000U, 4096U, 1U << 17U}) {
        settings.ray_budget = budget;
        const Rendered parts = render(renderer, settings);
        INFO("budget " << budget);
        CHECK(parts.image.pixels == whole.image.pixels);
        CHECK(same_counts(parts.statistics, whole.statistics));
    }
}

TEST_CASE("render: crops are parts of the whole, bit by bit", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings;
    settings.resolution = {61, 43};
    settings.depth = 3;
    settings.spp = GENERATE(1, 3);
    settings.seed = 5;
    const Rendered whole = render(renderer, settings);
    for (const Crop& crop : {Crop{0, 0, 61, 43}, Crop{0, 0, 1, 1}, Crop{60, 42, 61, 43}, Crop{7, 5, 48, 40},
                             Crop{30, 0, 31, 43}}) {
        settings.crop = crop;
        const Rendered part = render(renderer, settings);
        REQUIRE(part.image.width == crop.x1 - crop.x0);
        REQUIRE(part.image.height == crop.y1 - crop.y0);
        int wrong = 0;
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x)
                wrong += part.at(x - crop.x0, y - crop.y0) == whole.at(x, y) ? 0 : 1;
        }
        INFO("crop " << crop.x0 << "," << crop.y0 << "," << crop.x1 << "," << crop.y1);
        CHECK(wrong == 0);
    }
}

TEST_CASE("render: parts of the samples merge to the whole, bit by bit", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings = square_settings(24, 3);
    settings.spp = 16;
    settings.seed = 3;
    const Rendered whole = render(renderer, settings);
    std::uint64_t rays = 0;
    Film sum(test_device().memory(), 24, 24);
    // Not in order, of different lengths, with another budget for one.
    for (const SampleRange& part : {SampleRange{5, 16}, SampleRange{0, 1}, SampleRange{1, 5}}) {
        settings.samples = part;
        settings.ray_budget = part.begin == 1 ? 300 : 1U << 15U;
        Film film(test_device().memory(), 24, 24);
        rays += renderer.render(settings, film).generations[0].rays;
        CHECK(film.resolve(part.count()).pixels != whole.image.pixels);
        sum.merge(film);
    }
    CHECK(rays == whole.statistics.generations[0].rays);
    CHECK(sum.resolve(settings.spp).pixels == whole.image.pixels);

    Film film(test_device().memory(), 24, 24);
    for (const SampleRange& wrong : {SampleRange{0, 17}, SampleRange{-1, 4}, SampleRange{4, 4}}) {
        settings.samples = wrong;
        CHECK_THROWS_AS(renderer.render(settings, film), Error);
    }
}

TEST_CASE("render: a seed names an image, and one sample needs none", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings = square_settings(24, 2);
    const Rendered centre = render(renderer, settings);
    settings.seed = 1;
    CHECK(render(renderer, settings).image.pixels == centre.image.pixels);
    settings.spp = 4;
    const Rendered first = render(renderer, settings);
    CHECK(render(renderer, settings).image.pixels == first.image.pixels);
    settings.seed = 2;
    CHECK(render(renderer, settings).image.pixels != first.image.pixels);
}

TEST_CASE("render: progress is told to its end", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings = square_settings(16, 1);
    settings.spp = 3;
    settings.ray_budget = 256;
    Film film(test_device().memory(), 16, 16);
    std::uint64_t last = 0;
    bool rising = true;
    renderer.render(settings, film, [&](std::uint64_t done, std::uint64_t total) {
        rising = rising && done > last && total == 768;
        last = done;
    });
    CHECK(rising);
    CHECK(last == 768);
}

TEST_CASE("render: rows are final once progress says that their pixels are", "[render]") {
    Renderer renderer(test_device(), branching_scene());
    RenderSettings settings = square_settings(43, 3);
    settings.spp = 2;
    settings.ray_budget = 256;
    Film film(test_device().memory(), 43, 43);
    std::vector<std::int64_t> first_seen;
    int bands = 0;
    renderer.render(settings, film, [&](std::uint64_t done, std::uint64_t) {
        const auto final_sums = 3 * 43 * static_cast<std::size_t>(finished_rows(done / 2, 43, 43));
        if (final_sums > first_seen.size()) ++bands;
        const auto sums = film.sums().subspan(first_seen.size(), final_sums - first_seen.size());
        first_seen.insert(first_seen.end(), sums.begin(), sums.end());
    });
    // Of six strips of 8 rows the last, of 3, may be finished by the wave that finishes the one before.
    CHECK((bands == 5 || bands == 6));
    CHECK(std::equal(first_seen.begin(), first_seen.end(), film.sums().begin(), film.sums().end()));
}

/// White to the left of, or above, a slightly slanted line: each pixel row or column is cut at
/// another place.
Scene slanted_edge(bool upright) {
    Scene scene;
    scene.cameras[0] = {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 90};
    const float slant = 0.03F;
    if (upright) {
        add_polygon(scene, {{-9, -9, 0}, {-9 * slant, -9, 0}, {9 * slant, 9, 0}, {-9, 9, 0}},
                    emitting(glm::vec3(1)));
    } else {
        add_polygon(scene, {{9, 9 * slant, 0}, {9, 9, 0}, {-9, 9, 0}, {-9, -9 * slant, 0}},
                    emitting(glm::vec3(1)));
    }
    return scene;
}

// An edge nearly parallel to the pixel's side cuts N samples, one in each of N rows and columns, so
// that the share on one side is off by at most 1/N, and by 0.015 for the slant; twice that where
// the edge leaves the pixel for its neighbour.
TEST_CASE("render: samples are stratified in x and in y and unbiased", "[render]") {
    const bool upright = GENERATE(true, false);
    const int spp = GENERATE(16, 64);
    const int size = 64;
    const Scene scene = slanted_edge(upright);
    RenderSettings settings = square_settings(size, 0);
    settings.spp = spp;
    const Rendered rendered = render(scene, settings);
    double bias = 0;
    for (int i = 0; i < size; ++i) {
        // Place of the edge, in pixels, where it crosses the middle of row or column i.
        const double across = (i + 0.5) / size * 2 - 1;
        const double place = (0.5 - 0.5 * 0.03 * across) * size;
        double covered = 0;
        for (int j = 0; j < size; ++j) covered += upright ? rendered.at(j, i).x : rendered.at(i, j).x;
        const double error = covered - place;
        CHECK(std::abs(error) <= 2.0 / spp + 0.03);
        bias += error / size;
    }
    CHECK(std::abs(bias) < 0.5 / spp);
}

}  // namespace
}  // namespace sahl::tests
