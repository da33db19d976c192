// The memory contract: what is planned bounds what is held, and the least that is planned is enough.
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "engine/core/error.h"
#include "engine/film/aov.h"
#include "engine/oracle/build_scene.h"
#include "engine/render/host_scene.h"
#include "engine/render/memory_plan.h"
#include "engine/render/ray_queues.h"
#include "engine/self_test/every_feature.h"
#include "tests/device/soups.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

/// A camera among facing glass balls, within shells of glass that let through and reflect, within a mirror
/// all around: two children at nearly every hit, so that the tree of rays doubles with each generation.
Scene hall_of_glass() {
    Scene scene;
    scene.cameras[0] = {{0.05, 0.02, 0}, {1, 0, 0}, {0, 0, 1}, 80};
    scene.background = {0.2F, 0.3F, 0.4F};
    scene.lights = {oracle::point_light({0, 0.3, 0.5})};
    Material glass = oracle::glass({0.7F, 0.7F, 0.7F}, 1.2F);
    glass.reflection = glm::vec3(0.3F);
    glass.diffuse = glm::vec3(0.1F);
    for (const double x : {-2.0, 2.0}) {
        for (const double y : {-1.0, 0.0, 1.0}) {
            for (const double z : {-1.0, 0.0, 1.0}) oracle::add_sphere(scene, {{x, y, z}, 0.49}, glass);
        }
    }
    glass.ior = 1;  // nothing is reflected totally
    for (const double radius : {3.0, 4.0, 5.0, 6.0, 7.0})
        oracle::add_sphere(scene, {{0, 0, 0}, radius}, glass);
    Material mirror = oracle::matte(glm::vec3(0.1F));
    mirror.reflection = glm::vec3(0.9F);
    oracle::add_sphere(scene, {{0, 0, 0}, 9}, mirror);
    return scene;
}

MemoryRequest request_for(Device& device, const RenderSettings& settings, const Scene& scene) {
    return memory_request(device, settings, static_cast<std::uint32_t>(scene.lights.size()));
}

struct Contract {
    MemoryPlan plan;
    std::size_t peak = 0;
    Image image;
    std::uint64_t rays = 0;
};

/// Renders within `limit` on a device of its own, as the program does, AOVs and all.
Contract render_within(std::uint64_t limit, const Scene& scene, RenderSettings settings,
                       std::span<const Aov> aovs = {}) {
    Device device;
    device.memory().set_limit(limit);
    const MemoryRequest request = with_aovs(request_for(device, settings, scene), aovs);
    Renderer renderer(device, scene, request);
    Contract result;
    result.plan = renderer.memory_plan();
    settings.ray_budget = result.plan.ray_budget;
    const MemoryReservation layers(device.memory(), result.plan.aovs, "AOVs");
    if (!aovs.empty()) renderer.render_aovs(settings, aovs);
    Film film(device.memory(), settings.resolution.width, settings.resolution.height);
    for (const GenerationCounts& counts : renderer.render(settings, film).generations)
        result.rays += counts.rays;
    const MemoryReservation image(device.memory(), result.plan.image, "image");
    result.image = film.resolve(settings.spp);
    result.peak = device.memory().peak();
    return result;
}

/// The number in "... needs at least N bytes ...".
std::uint64_t least_named(const std::string& message) {
    const std::string before = "needs at least ";
    return std::stoull(message.substr(message.find(before) + before.size()));
}

std::string refusal(std::uint64_t limit, const Scene& scene, const RenderSettings& settings) {
    try {
        render_within(limit, scene, settings);
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::memory);
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("memory: ray queues take what the plan says", "[memory]") {
    for (const std::uint32_t rays : {1U, 64U, 1000U, 32768U, 300000U}) {
        for (const std::uint32_t lights : {0U, 1U, 7U}) {
            Device device;
            const RayQueues queues(device, rays, 5, lights);
            INFO(rays << " rays, " << lights << " lights");
            CHECK(device.memory().current() == ray_queue_bytes(rays, 5, lights));
        }
    }
}

TEST_CASE("memory: batches are small enough for the device's largest buffer", "[memory]") {
    Device& device = test_device();
    const std::size_t largest = device.info().max_allocation;
    CHECK(most_rays(device, 2) == device.max_work_items() * device.rays_per_item());
    for (const std::uint32_t lights : {100000U, 100000000U}) {
        const std::uint64_t rays = most_rays(device, lights);
        CHECK(rays >= 1);
        CHECK((rays == 1 || ray_capacity(static_cast<std::uint32_t>(rays)) * 12 * lights <= largest));
        CHECK(4 * rays * 12 * lights > largest / 4);
    }
}

TEST_CASE("memory: what is known before the trees are built bounds what they are", "[memory]") {
    const auto check = [](const Scene& scene) {
        const SceneMemory bound = bound_scene_memory(scene);
        const SceneMemory built = measure_scene_memory(scene, make_host_scene(scene), bound);
        CHECK(built.loaded == bound.loaded);
        CHECK(built.building == bound.building);
        CHECK(built.nodes <= bound.nodes);
        CHECK(built.leaf_blocks <= bound.leaf_blocks);
        CHECK(built.shapes <= bound.shapes);
        CHECK(built.instances == bound.instances);
        CHECK(built.materials == bound.materials);
        CHECK(built.device() < bound.building + bound.loaded + (1U << 16U));
    };
    check(Scene());
    check(every_feature());
    check(hall_of_glass());
    Random random(5);
    check(random_soup(random, 2000, 1, 10).scene);
    check(instanced_soup(random, 1, 10).scene);
    // Spheres far from each other along a line, and all in one place: few and many to a leaf.
    for (const double spread : {0.0, 1.0, 1.7}) {
        Scene scene;
        for (int i = 0; i < 3000; ++i)
            oracle::add_sphere(scene, {{std::pow(spread, i % 40) + i * spread, 0, 0}, 0.2},
                               oracle::matte(glm::vec3(1)));
        check(scene);
    }
}

TEST_CASE("memory: no more is held at one time than was planned", "[memory]") {
    const std::vector<Aov> all{Aov::depth, Aov::normal, Aov::albedo, Aov::primitive_id};
    const std::vector<Aov> costs{Aov::cost_rays, Aov::cost_nodes};
    for (const Scene& scene : {every_feature(), hall_of_glass(), Scene()}) {
        for (const int size : {16, 200}) {
            for (const std::span<const Aov> aovs :
                 {std::span<const Aov>(), std::span<const Aov>(all), std::span<const Aov>(costs)}) {
                const Contract result = render_within(1U << 30U, scene, square_settings(size, 3), aovs);
                INFO("size " << size << ", AOVs " << aovs.size());
                CHECK(result.peak <= result.plan.total());
                CHECK(result.peak >= result.plan.film + result.plan.image);
            }
        }
    }
}

TEST_CASE("memory: the least plan gives the pixels of the largest, and nothing less is taken", "[memory]") {
    const Scene scene = hall_of_glass();
    RenderSettings settings = square_settings(16, 12);
    const Contract roomy = render_within(std::uint64_t{4} << 30U, scene, settings);
    CHECK(roomy.rays > 16 * 16 * 1000);
    const std::uint64_t least = least_named(refusal(100000, scene, settings));
    const Contract tight = render_within(least, scene, settings);
    CHECK(tight.plan.total() == least);
    CHECK(tight.plan.ray_budget == least_ray_budget);
    CHECK(tight.peak <= least);
    CHECK(tight.rays == roomy.rays);
    CHECK(tight.image.pixels == roomy.image.pixels);
    CHECK(least_named(refusal(least - 1, scene, settings)) == least);
}

TEST_CASE("memory: a scene larger than the limit is refused before its trees are built", "[memory]") {
    Scene scene;
    for (int i = 0; i < 20000; ++i)
        oracle::add_sphere(scene, {{i % 200, i / 200, 0}, 0.3}, oracle::matte(glm::vec3(1)));
    const RenderSettings settings = square_settings(8, 0);
    const std::uint64_t least = least_named(refusal(1U << 20U, scene, settings));
    CHECK(least > scene.primitives.size() * sizeof(Primitive));
    CHECK(render_within(least, scene, settings).peak <= least);
    CHECK(least_named(refusal(least - 1, scene, settings)) == least);
}

}  // namespace sahl::tests
