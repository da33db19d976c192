// Light, children and shadows.
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

#include "engine/oracle/shading.h"
#include "engine/self_test/kernel_check.h"
#include "engine/self_test/kernel_tests.h"

namespace sahl::self_test {
namespace {

using glm::dvec3;

constexpr double allowed_of_shading = 2e-5;
constexpr double allowed_of_shadows = 1e-6;

/// What shade leaves for the other kernels.
struct Shaded {
    Shaded(RayQueues& q, Contributions& out, std::size_t lights)
        : light(out.light, q.capacity, 3),
          pixels(out.pixels, q.capacity, 1),
          surfaces(q.shadow_surfaces, q.capacity, SAHL_SURFACE_FLOATS),
          shadow_light(q.shadow_light, q.capacity, 3 * lights),
          outcomes(q.outcomes, q.capacity, 1),
          children(q.children, q.child_ids, q.capacity, 2) {}

    Arrays<float> light;
    Arrays<std::uint32_t> pixels;
    Arrays<float> surfaces;
    Arrays<float> shadow_light;
    Arrays<std::uint32_t> outcomes;
    BatchRays children;  ///< reflected, transmitted
};

bool attenuates(const Material& material) { return material.reflection_attenuation != glm::vec3(1, 0, 0); }

/// The ray's weight where it hits, less what the way took.
dvec3 weight_at_hit(const Scene& scene, const BatchRay& ray, double t) {
    if (!ray.attenuated) return ray.weight;
    const Primitive& start = scene.primitives[ray.start.primitive];
    return ray.weight * oracle::attenuated(scene.materials[start.material].reflection_attenuation, t);
}

/// A child as it has to be.
struct Child {
    dvec3 direction, weight;
    bool attenuated;
};

void compare_child(Difference& difference, const Child& expected, const oracle::Hit& hit,
                   const BatchRay& parent, const BatchRay& found) {
    difference.exact("child's pixel", parent.pixel, found.pixel);
    difference.exact("primitive the child starts on", hit.id.primitive, found.start.primitive);
    difference.exact("instance the child starts on", hit.id.instance, found.start.instance);
    difference.exact("child's attenuation", expected.attenuated ? 1 : 0, found.attenuated ? 1 : 0);
    difference.vector("child's origin", hit.position, found.exact.origin);
    difference.vector("child's direction", expected.direction, found.exact.direction);
    difference.vector("child's origin for traversal", hit.position, found.traced.origin);
    difference.vector("child's direction for traversal", expected.direction, found.traced.direction);
    difference.vector("child's weight", expected.weight, found.weight);
    // Off the surface on its own side; along the surface either will do.
    const double side = glm::dot(expected.direction, hit.ng);
    if (std::abs(side) < 1e-3) return;
    const bool right = glm::dot(found.traced.origin - hit.position, hit.ng) * side > 0;
    difference.exact("child starts on its side of the surface", 1, right ? 1 : 0);
}

/// The surface that shadow rays start from.
void compare_start(Difference& difference, const Shaded& shaded, std::size_t i, const oracle::Hit& hit) {
    const dvec3 offset = shaded.surfaces.vector(SAHL_SURFACE_OFFSET, i);
    const double length = glm::length(offset);
    difference.vector("position", hit.position, shaded.surfaces.vector(SAHL_SURFACE_POSITION, i));
    difference.vector("normal of the offset", hit.ng, offset / length);
    difference.exact("offset between 1e-8 and 1e-4", 1, length > 1e-8 && length < 1e-4 ? 1 : 0);
}

Difference compare_shading(const oracle::Oracle& reference, const BatchRay& in, const BatchHit& in_hit,
                           bool spawn, const Shaded& shaded, std::size_t i, const oracle::Ray& ray) {
    const Scene& scene = reference.scene();
    const dvec3 weight = weight_at_hit(scene, in, in_hit.t);
    const dvec3 light = shaded.light.vector(0, i);
    const std::uint32_t outcome = shaded.outcomes.at(0, i);
    Difference difference;
    difference.exact("pixel", in.pixel, shaded.pixels.at(0, i));
    if (!in_hit.hit()) {
        difference.vector("background's light", weight * dvec3(scene.background), light);
        difference.exact("children and shadow rays", 0, outcome);
        return difference;
    }
    const auto hit = reference.hit_near(ray, in_hit.id, in_hit.t);
    difference.exact("the surface is there", 1, hit ? 1 : 0);
    if (!hit) return difference;
    const Material& material = reference.material_of(*hit);
    const oracle::SurfaceColors colors = colors_at(scene, *hit);
    const dvec3 direction = glm::normalize(ray.direction);
    const dvec3 ns = shading_normal(material, *hit, direction);
    compare_start(difference, shaded, i, *hit);
    difference.vector("ambient light and emission", weight * own_light(scene, colors), light);
    std::uint32_t lit = 0;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const dvec3 brought =
            weight * light_at(scene.lights[l], material, colors, hit->position, ns, -direction).brought;
        lit += oracle::any_in_float(brought) ? 1 : 0;
        difference.vector("light to come", brought, shaded.shadow_light.vector(3 * l, i));
    }
    difference.exact("shadow rays", lit, outcome / SAHL_OUTCOME_SHADOW_RAY);

    const oracle::Scattering scattered = scatter(material, colors, *hit, direction);
    const bool reflects = spawn && scattered.kr != dvec3(0);
    const bool transmits = spawn && scattered.kt != dvec3(0);
    difference.exact("reflected rays", reflects ? 1 : 0, outcome & SAHL_OUTCOME_REFLECTED ? 1 : 0);
    difference.exact("transmitted rays", transmits ? 1 : 0, outcome & SAHL_OUTCOME_TRANSMITTED ? 1 : 0);
    if (reflects) {
        const Child child{scattered.reflected, weight * scattered.kr, attenuates(material)};
        compare_child(difference, child, *hit, in, shaded.children.at(i, 0));
    }
    if (transmits) {
        const Child child{scattered.transmitted, weight * scattered.kt, false};
        compare_child(difference, child, *hit, in, shaded.children.at(i, 1));
    }
    return difference;
}

}  // namespace

bool test_shade(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                const Generation& generation) {
    RayQueues& queues = wavefront.queues;
    RayBatch& batch = queues.batches[generation.in_work.slot];
    Contributions& out = queues.contributions[0];
    launch_shade(wavefront, generation.in_work, generation.spawn, out);
    const BatchRays rays(batch.rays, batch.ids, queues.capacity);
    const BatchHits hits(queues);
    const Shaded shaded(queues, out, reference.scene().lights.size());

    const auto compare = [&](std::size_t i, const oracle::Ray& ray) {
        return compare_shading(reference, rays.at(i), hits.at(i), generation.spawn, shaded, i, ray);
    };
    const auto exact = [&](std::size_t i) { return rays.at(i).exact; };
    return check_rays(
        test, {generation.in_work.generation, generation.in_work.count, allowed_of_shading, exact}, compare);
}

bool test_shadow(KernelTest& test, Wavefront& wavefront, const oracle::Oracle& reference,
                 const Generation& generation) {
    const std::vector<Light>& lights = reference.scene().lights;
    RayQueues& queues = wavefront.queues;
    Contributions& out = queues.contributions[0];
    const Shaded shaded(queues, out, lights.size());
    const BatchHits hits(queues);
    launch_shadow(wavefront, generation.in_work, out);
    const Arrays<float> arrived(out.light, queues.capacity, 3);

    const auto compare = [&](std::size_t i, const oracle::Ray& ray) {
        dvec3 sum = shaded.light.vector(0, i);
        const bool lit = shaded.outcomes.at(0, i) >= SAHL_OUTCOME_SHADOW_RAY;
        for (std::size_t l = 0; lit && l < lights.size(); ++l) {
            const dvec3 brought = shaded.shadow_light.vector(3 * l, i);
            if (brought == dvec3(0)) continue;
            const bool directional = lights[l].kind == LightKind::directional;
            const dvec3 side = directional ? lights[l].position : lights[l].position - ray.origin;
            const dvec3 offset = shaded.surfaces.vector(SAHL_SURFACE_OFFSET, i);
            const dvec3 start = glm::dot(side, offset) < 0 ? ray.origin - offset : ray.origin + offset;
            const dvec3 to_light = directional ? side : lights[l].position - start;
            int crossed = 0;
            sum += brought * reference.transmittance({start, to_light}, directional ? oracle::infinity : 1.0,
                                                     hits.at(i).id, crossed);
        }
        Difference difference;
        difference.vector("light that arrives", sum, arrived.vector(0, i));
        return difference;
    };
    // Towards the surface: moved rays start beside each other on it, whatever lights there are.
    const auto start = [&](std::size_t i) {
        if (!hits.at(i).hit()) return oracle::Ray{dvec3(0), dvec3(0, 0, 1)};
        return oracle::Ray{shaded.surfaces.vector(SAHL_SURFACE_POSITION, i),
                           -glm::normalize(shaded.surfaces.vector(SAHL_SURFACE_OFFSET, i))};
    };
    return check_rays(
        test, {generation.in_work.generation, generation.in_work.count, allowed_of_shadows, start}, compare);
}

}  // namespace sahl::self_test
