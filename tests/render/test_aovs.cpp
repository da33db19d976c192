// Output variables against the oracle's first hits.
#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/shading.h"
#include "engine/self_test/every_feature.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

using glm::dvec3;

constexpr Aov kAll[] = {Aov::depth,        Aov::normal,      Aov::albedo,
                        Aov::primitive_id, Aov::instance_id, Aov::material_id};

/// What an AOV image has of a pixel: three values, one, or an id.
struct Pixel {
    double depth;
    dvec3 normal, albedo;
    std::uint32_t primitive, instance, material;
};

Pixel pixel_of(const std::vector<AovImage>& images, std::size_t i) {
    const auto vector = [&](std::size_t image) {
        const std::vector<float>& v = images[image].values;
        return dvec3(v.at(3 * i), v.at(3 * i + 1), v.at(3 * i + 2));
    };
    return {static_cast<double>(images[0].values.at(i)),
            vector(1),
            vector(2),
            images[3].uints.at(i),
            images[4].uints.at(i),
            images[5].uints.at(i)};
}

/// Pixels of `images` (of `crop`) that are not the oracle's; at edges either side is right.
int wrong_pixels(const Scene& scene, const RenderSettings& settings, const Crop& crop,
                 const std::vector<AovImage>& images) {
    const oracle::Oracle reference(scene);
    const Camera& camera = scene.cameras[settings.camera];
    const dvec3 forward = glm::normalize(camera.look_at - camera.eye);
    const auto hit_at = [&](double x, double y) {
        return reference.closest_hit(oracle::camera_ray(camera, settings.resolution, x, y));
    };
    int wrong = 0, compared = 0;
    std::size_t i = 0;
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x, ++i) {
            const oracle::Ray ray = oracle::camera_ray(camera, settings.resolution, x + 0.5, y + 0.5);
            const auto hit = reference.closest_hit(ray);
            const auto albedo_of = [&](const oracle::Hit& h) {
                return oracle::colors_at(reference.scene(), h).diffuse;
            };
            bool edge = false;
            for (const double side : {-0.01, 0.01}) {
                for (const double other : {-0.01, 0.01}) {
                    const auto near = hit_at(x + 0.5 + side, y + 0.5 + other);
                    edge = edge || near.has_value() != hit.has_value() ||
                           (hit && (!(near->id == hit->id) || near->part != hit->part ||
                                    glm::distance(albedo_of(*near), albedo_of(*hit)) > 0.01));
                }
            }
            if (edge) continue;
            ++compared;
            const Pixel pixel = pixel_of(images, i);
            if (!hit) {
                wrong += pixel.depth != std::numeric_limits<double>::infinity() || pixel.normal != dvec3(0) ||
                         pixel.albedo != dvec3(0) || pixel.primitive != no_aov_id ||
                         pixel.instance != no_aov_id || pixel.material != no_aov_id;
                continue;
            }
            const bool turned = reference.material_of(*hit).two_sided && glm::dot(hit->ns, ray.direction) > 0;
            const double depth = glm::dot(hit->position - camera.eye, forward);
            wrong += std::abs(pixel.depth - depth) > 1e-6 * depth ||
                     glm::distance(pixel.normal, turned ? -hit->ns : hit->ns) > 1e-5 ||
                     glm::distance(pixel.albedo, albedo_of(*hit)) > 1e-5 ||
                     pixel.primitive != hit->id.primitive || pixel.instance != hit->id.instance ||
                     pixel.material != scene.primitives[hit->id.primitive].material;
        }
    }
    CHECK(compared > static_cast<int>(i) * 8 / 10);
    return wrong;
}

TEST_CASE("render: output variables are the oracle's", "[render][oracle]") {
    Scene scene = every_feature();
    // Without the room around it all, some rays miss.
    std::erase_if(scene.primitives,
                  [](const Primitive& primitive) { return primitive.sides == Sides::back; });
    for (Group& group : scene.groups) --group.first_primitive;
    scene.materials[scene.primitives[1].material].two_sided = false;
    scene.cameras.push_back({{-5, 4, 2}, {0, 0, 1}, {0, 0.2, 1}, 60, "behind"});
    Renderer renderer(test_device(), scene);
    RenderSettings settings;
    settings.resolution = {96, 64};
    SECTION("of the whole image") {
        const auto images = renderer.render_aovs(settings, kAll);
        REQUIRE(images.size() == std::size(kAll));
        for (std::size_t i = 0; i < images.size(); ++i) CHECK((images[i].aov == kAll[i]));
        CHECK(wrong_pixels(scene, settings, {0, 0, 96, 64}, images) == 0);
        CHECK(std::count(images[3].uints.begin(), images[3].uints.end(), no_aov_id) > 100);
        CHECK(std::count(images[4].uints.begin(), images[4].uints.end(), 0U) > 100);
        CHECK(std::count(images[4].uints.begin(), images[4].uints.end(), 3U) > 10);
    }
    SECTION("of a crop, in small batches") {
        settings.crop = Crop{17, 9, 90, 60};
        settings.ray_budget = 100;
        CHECK(wrong_pixels(scene, settings, *settings.crop, renderer.render_aovs(settings, kAll)) == 0);
    }
    SECTION("of another camera") {
        settings.camera = 1;
        CHECK(wrong_pixels(scene, settings, {0, 0, 96, 64}, renderer.render_aovs(settings, kAll)) == 0);
    }
    SECTION("one alone, and none") {
        const Aov one[] = {Aov::instance_id};
        const auto alone = renderer.render_aovs(settings, one);
        REQUIRE(alone.size() == 1);
        CHECK(alone[0].values.empty());
        CHECK(alone[0].uints == renderer.render_aovs(settings, kAll)[4].uints);
        CHECK(renderer.render_aovs(settings, {}).empty());
    }
    SECTION("with costs between them, in the order asked for") {
        const Aov mixed[] = {Aov::cost_nodes, Aov::depth, Aov::cost_rays, Aov::instance_id};
        const auto images = renderer.render_aovs(settings, mixed);
        REQUIRE(images.size() == 4);
        for (std::size_t i = 0; i < 4; ++i) CHECK((images[i].aov == mixed[i]));
        CHECK(images[1].values == renderer.render_aovs(settings, kAll)[0].values);
        CHECK(images[0].uints != images[2].uints);
    }
    SECTION("of many samples: the first's, within the pixel") {
        settings.spp = 16;
        const auto images = renderer.render_aovs(settings, kAll);
        CHECK(images[0].values == renderer.render_aovs(settings, kAll)[0].values);
        settings.spp = 1;
        CHECK(images[0].values != renderer.render_aovs(settings, kAll)[0].values);
    }
}

TEST_CASE("render: depth is across the view, not along the ray", "[render]") {
    Scene scene;
    scene.cameras[0] = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 90};
    oracle::add_square(scene, 0, 100, {});
    Renderer renderer(test_device(), scene);
    const Aov depth[] = {Aov::depth};
    const auto images = renderer.render_aovs(square_settings(9, 0), depth);
    for (const float z : images[0].values) CHECK(z == Approx(3).epsilon(1e-6));
}

}  // namespace
}  // namespace sahl::tests
