// Rendering that is stopped: finished pixels stay as they would have been, of the others nothing does.
#include <chrono>
#include <stdexcept>
#include <stop_token>
#include <thread>

#include <catch2/catch.hpp>

#include "engine/oracle/build_scene.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

constexpr int size = 24;

/// Glass balls before a bright background: no pixel is black.
Scene glass_balls() {
    Scene scene;
    scene.cameras[0] = {{0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 40};
    scene.background = {0.2F, 0.3F, 0.5F};
    Material glass = oracle::glass({0.8F, 0.9F, 0.8F}, 1.3F);
    glass.reflection = glm::vec3(0.2F);
    glass.ambient = glm::vec3(0.1F);
    for (int i = 0; i < 9; ++i) oracle::add_sphere(scene, {{i % 3 - 1, i / 3 - 1, 0}, 0.45}, glass);
    return scene;
}

/// With waves that end within a pixel.
RenderSettings small_waves() {
    RenderSettings settings = square_settings(size, 5);
    settings.spp = 3;
    settings.ray_budget = 64;
    return settings;
}

Rendered render_until(Renderer& renderer, const RenderSettings& settings, const ProgressCallback& progress,
                      const std::stop_token& stop) {
    Film film(test_device().memory(), size, size);
    const RenderStatistics statistics = renderer.render(settings, film, progress, stop);
    return {film.resolve(settings.spp), statistics};
}

/// As many pixels are `whole`'s as the statistics say, all others black.
void check_part(const Rendered& part, const Rendered& whole) {
    std::uint64_t finished = 0;
    int wrong = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            REQUIRE(whole.at(x, y) != glm::dvec3(0));
            if (part.at(x, y) == whole.at(x, y)) {
                ++finished;
            } else {
                wrong += part.at(x, y) == glm::dvec3(0) ? 0 : 1;
            }
        }
    }
    CHECK(wrong == 0);
    CHECK(finished == part.statistics.finished_pixels);
}

}  // namespace

TEST_CASE("stop: after some waves their pixels are finished, those that they share with the next are black",
          "[render]") {
    Renderer renderer(test_device(), glass_balls());
    const RenderSettings settings = small_waves();
    const Rendered whole = render(renderer, settings);
    CHECK(whole.statistics.finished_pixels == size * size);
    for (const std::uint64_t waves : {1, 2, 20}) {
        INFO(waves << " waves");
        std::stop_source stop;
        std::uint64_t finished = 0;  // in whole waves, of which several may end at once
        const auto after_waves = [&](std::uint64_t done, std::uint64_t) {
            if (done < waves * settings.ray_budget || stop.stop_requested()) return;
            finished = done;
            stop.request_stop();
        };
        const Rendered part = render_until(renderer, settings, after_waves, stop.get_token());
        CHECK(finished % settings.ray_budget == 0);
        CHECK(part.statistics.finished_pixels == finished / 3);
        check_part(part, whole);
    }
}

TEST_CASE("stop: a request during the last wave comes too late", "[render]") {
    Renderer renderer(test_device(), glass_balls());
    std::stop_source stop;
    const auto at_the_end = [&](std::uint64_t done, std::uint64_t all) {
        if (done == all) stop.request_stop();
    };
    const Rendered image = render_until(renderer, small_waves(), at_the_end, stop.get_token());
    CHECK(image.statistics.finished_pixels == size * size);
    CHECK(image.image.pixels == render(renderer, small_waves()).image.pixels);
}

TEST_CASE("stop: an error while other waves are on their way leaves a renderer that works", "[render]") {
    Renderer renderer(test_device(), glass_balls());
    const Rendered whole = render(renderer, small_waves());
    const auto fail = [](std::uint64_t, std::uint64_t) { throw std::runtime_error("no more"); };
    CHECK_THROWS_WITH(render_until(renderer, small_waves(), fail, {}), "no more");
    CHECK(render(renderer, small_waves()).image.pixels == whole.image.pixels);
}

TEST_CASE("stop: within a wave, at any moment", "[render]") {
    Renderer renderer(test_device(), glass_balls());
    for (const bool one_wave : {true, false}) {
        RenderSettings settings = small_waves();
        settings.spp = 16;
        settings.depth = 10;
        if (one_wave) settings.ray_budget = 1U << 20U;
        const Rendered whole = render(renderer, settings);
        for (int eighth = 0; eighth < 8; ++eighth) {
            std::stop_source stop;
            const std::chrono::duration<double> moment(whole.statistics.seconds * eighth / 8);
            const std::jthread other([&stop, moment] {
                std::this_thread::sleep_for(moment);
                stop.request_stop();
            });
            check_part(render_until(renderer, settings, {}, stop.get_token()), whole);
        }
    }
}

}  // namespace sahl::tests
