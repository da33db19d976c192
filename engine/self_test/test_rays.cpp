// Camera rays and hits.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/oracle/camera.h"
#include "engine/oracle/shading.h"
#include "engine/render/camera_constants.h"
#include "engine/self_test/kernel_check.h"
#include "engine/self_test/kernel_tests.h"

namespace sahl::self_test {
namespace {

using glm::dvec3;

constexpr double allowed_of_rays = 1e-6;
constexpr double allowed_of_hits = 2e-5;

/// The pixels of a crop in the order of waves: strips of eight rows in blocks of four columns, row by row.
std::vector<std::uint32_t> wave_order(std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t top = 0; top < height; top += 8) {
        for (std::uint32_t left = 0; left < width; left += 4) {
            for (std::uint32_t y = top; y < std::min(top + 8, height); ++y) {
                for (std::uint32_t x = left; x < std::min(left + 4, width); ++x)
                    order.push_back(y * width + x);
            }
        }
    }
    return order;
}

/// A triangle's (u, v) as the kernels have them: of corners that mirroring by its own transform swaps.
glm::dvec2 barycentrics(const Scene& scene, const oracle::Hit& hit) {
    const glm::dvec2& uv = hit.barycentric;
    const glm::dmat4& transform = scene.transforms[scene.primitives[hit.id.primitive].transform];
    return glm::determinant(glm::dmat3(transform)) < 0 ? glm::dvec2(uv.y, uv.x) : uv;
}

}  // namespace

bool test_generate(KernelTest& test, Wavefront& wavefront, const TestWave& wave) {
    const RenderSettings& settings = wave.settings;
    device::WaveConstants constants = wave_constants(settings, wave.crop);
    const std::uint32_t width = constants.crop_width;
    const std::vector<std::uint32_t> order = wave_order(width, constants.crop_height);
    constants.count = static_cast<std::uint32_t>(order.size()) * constants.samples;
    RayQueues& queues = wavefront.queues;
    launch_generate(wavefront, camera_constants(wave.camera, settings.resolution), constants,
                    queues.batches[0]);
    const BatchRays rays(queues.batches[0].rays, queues.batches[0].ids, queues.capacity);

    const auto pixel = [&](std::size_t i) { return order[i / constants.samples]; };
    const auto camera_ray = [&](std::size_t i) {
        const std::uint32_t x = constants.crop_x + pixel(i) % width;
        const std::uint32_t y = constants.crop_y + pixel(i) / width;
        const auto sample = static_cast<std::uint32_t>(constants.first_sample + i % constants.samples);
        const glm::dvec2 in_pixel = oracle::pixel_sample(x, y, sample, constants.spp, settings.seed);
        return oracle::camera_ray(wave.camera, settings.resolution, x + in_pixel.x, y + in_pixel.y);
    };
    const auto compare = [&](std::size_t i, const oracle::Ray& expected) {
        const BatchRay found = rays.at(i);
        Difference difference;
        difference.exact("pixel", pixel(i), found.pixel);
        difference.exact("primitive it starts on", oracle::no_primitive, found.start.primitive);
        difference.exact("attenuation", 0, found.attenuated ? 1 : 0);
        difference.vector("origin", expected.origin, found.exact.origin);
        difference.vector("direction", expected.direction, found.exact.direction);
        difference.vector("origin for traversal", expected.origin, found.traced.origin);
        difference.vector("direction for traversal", expected.direction, found.traced.direction);
        difference.vector("weight", dvec3(1), found.weight);
        return difference;
    };
    return check_rays(test, {0, constants.count, allowed_of_rays, camera_ray}, compare);
}

bool test_intersect(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                    const Generation& generation) {
    RayQueues& queues = wavefront.queues;
    RayBatch& batch = queues.batches[generation.in_work.slot];
    launch_intersect(wavefront, generation.in_work);
    const BatchRays rays(batch.rays, batch.ids, queues.capacity);
    const BatchHits hits(queues);

    const auto compare = [&](std::size_t i, const oracle::Ray& ray) {
        const BatchHit found = hits.at(i);
        const auto expected = reference.closest_hit(ray, 0, oracle::infinity, rays.at(i).start);
        const oracle::SurfaceId id = expected ? expected->id : oracle::SurfaceId{};
        Difference difference;
        difference.exact("primitive hit (4294967295: none)", id.primitive, found.id.primitive);
        if (!expected || !found.hit()) return difference;
        difference.exact("instance hit", id.instance, found.id.instance);
        // Errors count across the surface: along a grazing ray they are that much longer.
        const double cosine = std::abs(glm::dot(expected->ng, glm::normalize(ray.direction)));
        difference.number("t", expected->t, found.t, cosine);
        const glm::dvec2 uv = barycentrics(reference.scene(), *expected);
        difference.number("u", uv.x, found.u, cosine);
        difference.number("v", uv.y, found.v, cosine);
        return difference;
    };
    const auto traced = [&](std::size_t i) { return rays.at(i).traced; };
    return check_rays(
        test, {generation.in_work.generation, generation.in_work.count, allowed_of_hits, traced}, compare);
}

bool test_describe(KernelTest& test, Wavefront& wavefront, Kernel& describe, const oracle::Oracle& reference,
                   const TestWave& wave) {
    constexpr Aov all[] = {Aov::depth,        Aov::normal,      Aov::albedo,
                           Aov::primitive_id, Aov::instance_id, Aov::material_id};
    const Resolution& resolution = wave.settings.resolution;
    const std::vector<AovImage> images = trace_aovs(
        wavefront, describe, camera_constants(wave.camera, resolution), wave.settings, wave.crop, all);
    const Scene& scene = reference.scene();
    const dvec3 forward = glm::normalize(wave.camera.look_at - wave.camera.eye);
    const auto width = static_cast<std::size_t>(wave.crop.x1 - wave.crop.x0);
    const auto height = static_cast<std::size_t>(wave.crop.y1 - wave.crop.y0);
    const auto camera_ray = [&](std::size_t i) {
        const auto x = static_cast<std::uint32_t>(wave.crop.x0) + static_cast<std::uint32_t>(i % width);
        const auto y = static_cast<std::uint32_t>(wave.crop.y0) + static_cast<std::uint32_t>(i / width);
        const glm::dvec2 in_pixel =
            oracle::pixel_sample(x, y, 0, static_cast<std::uint32_t>(wave.settings.spp), wave.settings.seed);
        return oracle::camera_ray(wave.camera, resolution, x + in_pixel.x, y + in_pixel.y);
    };
    const auto found_vector = [&](std::size_t image, std::size_t i) {
        const std::vector<float>& values = images[image].values;
        return dvec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    };
    const auto compare = [&](std::size_t i, const oracle::Ray& ray) {
        Difference difference;
        const auto depth = static_cast<double>(images[0].values[i]);
        const auto hit = reference.closest_hit(ray);
        difference.exact("primitive id", hit ? hit->id.primitive : no_aov_id, images[3].uints[i]);
        difference.exact("instance id", hit ? hit->id.instance : no_aov_id, images[4].uints[i]);
        if (!hit) {
            difference.exact("material id", no_aov_id, images[5].uints[i]);
            difference.number("depth", oracle::infinity, depth);
            difference.vector("normal", dvec3(0), found_vector(1, i));
            difference.vector("albedo", dvec3(0), found_vector(2, i));
            return difference;
        }
        const Material& material = reference.material_of(*hit);
        const double cosine = std::abs(glm::dot(hit->ng, ray.direction));
        difference.exact("material id", scene.primitives[hit->id.primitive].material, images[5].uints[i]);
        difference.number("depth", glm::dot(hit->position - wave.camera.eye, forward), depth, cosine);
        difference.vector("normal", shading_normal(material, *hit, ray.direction), found_vector(1, i));
        difference.vector("albedo", colors_at(scene, *hit).diffuse, found_vector(2, i));
        return difference;
    };
    return check_rays(test, {0, width * height, allowed_of_hits, camera_ray}, compare);
}

}  // namespace sahl::self_test
