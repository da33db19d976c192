// Which batches are traced by packets and which by streams.
#include <catch2/catch.hpp>

#include <map>
#include <random>

#include "engine/self_test/self_test.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

/// A floor and a ceiling of mirrors, the camera between them.
Scene flat_mirrors() {
    Scene scene;
    scene.cameras = {{{0, 0, 0.3}, {10, 3, 0}, {0, 0, 1}, 60, "camera"}};
    scene.materials.emplace_back().reflection = {0.9, 0.9, 0.9};
    for (const double z : {-1.0, 1.0}) {
        scene.primitives.push_back({PrimitiveKind::sphere, static_cast<std::uint32_t>(scene.spheres.size())});
        scene.spheres.push_back({{0, 0, 1e5 * z + z}, 1e5});
    }
    return scene;
}

/// Balls of a mirror, small ones: where neighbours' rays go has nothing in common once they met two of them.
Scene balls_of_mirror() {
    Scene scene;
    scene.cameras = {{{0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50, "camera"}};
    scene.materials.emplace_back().reflection = {0.9, 0.9, 0.9};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-3, 3);
    for (int i = 0; i < 4000; ++i) {
        scene.primitives.push_back({PrimitiveKind::sphere, static_cast<std::uint32_t>(scene.spheres.size())});
        scene.spheres.push_back({{uniform(random), uniform(random), uniform(random) / 3}, 0.05});
    }
    return scene;
}

/// Of many pixels, not samples: those of one pixel keep together.
RenderSettings many_rays() { return square_settings(512, 4); }

/// Rays by generation and kernel that intersects them.
using RaysByKernel = std::map<std::pair<std::uint32_t, std::string>, std::uint64_t>;

RaysByKernel intersecting(Device& device, Renderer& renderer, const RenderSettings& settings, Image& image) {
    device.launches().enable(true);
    image = render(renderer, settings).image;
    device.launches().enable(false);
    RaysByKernel rays;
    for (const LaunchRecord& launch : device.launches().take()) {
        if (launch.kernel.starts_with("intersect")) rays[{launch.generation, launch.kernel}] += launch.items;
    }
    return rays;
}

TEST_CASE("choice of traversal: rays that keep together are traced by packets in all generations",
          "[render]") {
    Device& device = test_device();
    Renderer renderer(device, flat_mirrors());
    Image image;
    for (const auto& [launch, count] : intersecting(device, renderer, square_settings(256, 4), image)) {
        INFO("generation " << launch.first);
        CHECK(launch.second == "intersect_packet");
    }
}

TEST_CASE("choice of traversal: rays that part are traced by streams, once they are enough", "[render]") {
    Device& device = test_device();
    run_self_test(device);  // or its launches would be among the image's
    const Scene scene = balls_of_mirror();
    Renderer renderer(device, scene);
    const RenderSettings settings = many_rays();
    Image image;
    RaysByKernel rays = intersecting(device, renderer, settings, image);
    CHECK_FALSE(rays.contains({0, "intersect_stream"}));
    CHECK(rays.contains({2, "intersect_packet"}));  // when they were few
    CHECK(rays.contains({2, "intersect_stream"}));
    Image again;
    rays = intersecting(device, renderer, settings, again);
    // But for a few in small batches.
    CHECK(rays[{2, "intersect_packet"}] < rays[{2, "intersect_stream"}] / 100);
    CHECK(again.pixels == image.pixels);

    DeviceOptions packets;
    packets.traversal = Traversal::packet;
    Device device_of_packets(packets);
    Renderer renderer_of_packets(device_of_packets, scene);
    for (const auto& [launch, count] : intersecting(device_of_packets, renderer_of_packets, settings, again))
        CHECK(launch.second == "intersect_packet");
    CHECK(again.pixels == image.pixels);
}

TEST_CASE("choice of traversal: visits are counted the way that rays are traced", "[render]") {
    Renderer renderer(test_device(), balls_of_mirror());
    const RenderSettings settings = many_rays();
    const std::vector<GenerationVisits> before = renderer.count_visits(settings);
    CHECK_FALSE(before[2].intersect.contains("stream"));
    const std::vector<GenerationCounts> counts = render(renderer, settings).statistics.generations;
    const std::vector<GenerationVisits> visits = renderer.count_visits(settings);
    CHECK(visits[0].intersect.size() == 1);
    CHECK(visits[2].intersect.at("stream").rays > counts[2].rays / 100 * 99);
    for (std::size_t generation = 0; generation < visits.size(); ++generation) {
        std::uint64_t rays = 0;
        for (const auto& [way, of_way] : visits[generation].intersect) rays += of_way.rays;
        CHECK(rays == counts[generation].rays);
    }
}

}  // namespace
}  // namespace sahl::tests
