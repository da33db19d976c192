// Counts of what rays visit: scenes whose trees can be walked by hand.
#include <catch2/catch.hpp>

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

}  // namespace

TEST_CASE("visits: of one sphere packets open the root once for 128 rays", "[render]") {
    Renderer renderer(test_device(), one_sphere());
    const RenderSettings settings = square_settings(64, 0);
    const std::vector<GenerationVisits> visits = renderer.count_visits(settings);
    REQUIRE(visits.size() == 1);
    const std::uint64_t rays = 64 * 64;
    CHECK(visits[0].hits == rays);
    CHECK(visits[0].lit == rays);  // nothing is between hit and light
    CHECK(visits[0].intersect.nodes >= rays / 128);
    CHECK(visits[0].intersect.nodes <= rays);
    CHECK(visits[0].intersect.leaves == visits[0].intersect.nodes);
    CHECK(visits[0].intersect.leaf_bytes == visits[0].intersect.leaves * sizeof(device::SphereBlock));
    CHECK(visits[0].intersect.flop > rays * 6);
}

TEST_CASE("visits: rays that miss everything open the root alone", "[render]") {
    Scene scene = one_sphere();
    scene.cameras[0].look_at = {0, 0, 1};
    Renderer renderer(test_device(), scene);
    const std::vector<GenerationVisits> visits = renderer.count_visits(square_settings(64, 0));
    CHECK(visits[0].hits == 0);
    CHECK(visits[0].intersect.nodes >= 64 * 64 / 128);
    CHECK(visits[0].intersect.leaves == 0);
    CHECK(visits[0].shadow.nodes == 0);
}

}  // namespace sahl::tests
