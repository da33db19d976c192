// Counts of what rays visit: scenes whose trees can be walked by hand.
#include <numeric>

#include <catch2/catch.hpp>

#include "engine/self_test/every_feature.h"

#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

/// A sphere that fills the view and a light where the camera is.
Scene one_sphere() {
    Scene scene;
    scene.cameras.push_back({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 20, "camera"});
    scene.materials.emplace_back().diffuse = {1, 1, 1};
    scene.spheres.push_back({{0, 0, -10}, 5});
    Primitive sphere;
    sphere.kind = PrimitiveKind::sphere;
    scene.primitives.push_back(sphere);
    Light light;
    light.position = {0, 0, 0};
    scene.lights.push_back(light);
    return scene;
}

std::uint64_t sum_of(const std::vector<std::uint32_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

const KernelVisits& packets_of(const GenerationVisits& visits) {
    REQUIRE(visits.intersect.size() == 1);
    return visits.intersect.at("packet").visits;
}

constexpr Aov costs[] = {Aov::cost_rays, Aov::cost_nodes};

}  // namespace

TEST_CASE("visits: of one sphere packets open the root once for 128 rays", "[render]") {
    Renderer renderer(test_device(), one_sphere());
    const RenderSettings settings = square_settings(64, 0);
    const std::vector<GenerationVisits> visits = renderer.count_visits(settings);
    REQUIRE(visits.size() == 1);
    const std::uint64_t rays = 64 * 64;
    CHECK(visits[0].hits() == rays);
    CHECK(visits[0].lit == rays);  // nothing is between hit and light
    CHECK(packets_of(visits[0]).nodes >= rays / 128);
    CHECK(packets_of(visits[0]).nodes <= rays);
    CHECK(packets_of(visits[0]).leaves == packets_of(visits[0]).nodes);
    CHECK(packets_of(visits[0]).leaf_bytes == packets_of(visits[0]).leaves * sizeof(device::SphereBlock));
    CHECK(packets_of(visits[0]).flop > rays * 6);
    // Additions, multiplications and divisions of shading: the background; the ray in full, position, offset
    // and side; the sphere; what it emits; the lamp's direction, its light, and the cosine of it.
    CHECK(visits[0].shade.flop == rays * (3 + 27 + 55 + 6 + 33));
}

TEST_CASE("visits: rays that miss everything open the root alone", "[render]") {
    Scene scene = one_sphere();
    scene.cameras[0].look_at = {0, 0, 1};
    Renderer renderer(test_device(), scene);
    const std::vector<GenerationVisits> visits = renderer.count_visits(square_settings(64, 0));
    CHECK(visits[0].hits() == 0);
    CHECK(packets_of(visits[0]).nodes >= 64 * 64 / 128);
    CHECK(packets_of(visits[0]).leaves == 0);
    CHECK(visits[0].shadow.nodes == 0);
    CHECK(visits[0].shade.flop == 64 * 64 * 3);
}

TEST_CASE("visits: a pixel of one sphere costs a ray and a shadow ray, each the root", "[render]") {
    Scene scene = one_sphere();
    Renderer renderer(test_device(), scene);
    RenderSettings settings = square_settings(16, 0);
    const auto images = renderer.render_aovs(settings, costs);
    REQUIRE(images.size() == 2);
    CHECK(images[0].uints == std::vector<std::uint32_t>(256, 2));
    CHECK(images[1].uints == std::vector<std::uint32_t>(256, 2));
    settings.spp = 3;
    CHECK(renderer.render_aovs(settings, costs)[1].uints == std::vector<std::uint32_t>(256, 6));
    settings.samples = {1, 2};
    CHECK(renderer.render_aovs(settings, costs)[0].uints == std::vector<std::uint32_t>(256, 2));

    scene.cameras[0].look_at = {0, 0, 1};  // away from it
    renderer.set_scene(scene);
    CHECK(renderer.render_aovs(settings, costs)[0].uints == std::vector<std::uint32_t>(256, 1));
}

TEST_CASE("visits: costs of pixels are the rays of the render, and the nodes of rays one by one",
          "[render]") {
    const Scene scene = every_feature();
    Renderer renderer(test_device(), scene);
    RenderSettings settings = square_settings(48, 3);
    settings.spp = 2;
    const auto images = renderer.render_aovs(settings, costs);
    std::uint64_t rays = 0;
    for (const GenerationCounts& counts : render(renderer, settings).statistics.generations) {
        rays += counts.rays + counts.shadow_rays;
    }
    CHECK(sum_of(images[0].uints) == rays);

    DeviceOptions ray_by_ray;
    ray_by_ray.traversal = Traversal::scalar;
    Device one_by_one(ray_by_ray);
    std::uint64_t nodes = 0;
    for (const GenerationVisits& visits : Renderer(one_by_one, scene).count_visits(settings)) {
        nodes += visits.intersect.at("scalar").visits.nodes + visits.shadow.nodes;
    }
    CHECK(sum_of(images[1].uints) == nodes);

    // In whatever batches, and of a crop that part.
    settings.ray_budget = 100;
    settings.crop = Crop{7, 11, 40, 30};
    const auto part = renderer.render_aovs(settings, costs);
    int wrong = 0;
    for (std::size_t i = 0; i < 33 * 19; ++i) {
        const std::size_t whole = (11 + i / 33) * 48 + 7 + i % 33;
        wrong +=
            part[0].uints.at(i) != images[0].uints[whole] || part[1].uints.at(i) != images[1].uints[whole];
    }
    CHECK(wrong == 0);
}

}  // namespace sahl::tests
