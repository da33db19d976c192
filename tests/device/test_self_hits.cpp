// Rays that leave a surface do not meet it where they start, at any scale: the engine's own shade and shadow
// kernels, then its traversal. Surfaces are convex, so that a mirrored ray outside meets nothing more, every
// lit point is lit, and a ray inside meets the surface again across the chord.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"
#include "tests/device/closed_meshes.h"
#include "tests/device/random_shapes.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

struct Object {
    std::string name;
    Scene scene;
    dvec3 center;
    double size;  ///< every direction from the centre meets a closed object
};

struct SelfHitScore {
    int hits = 0, lit = 0, children = 0;
    int self_hits = 0;  ///< children that meet their own surface at once
    int edge_hits =
        0;  ///< children from an edge that meet its other face at once: they may have started on either
    int leaks = 0;     ///< children inside that get out unseen
    int shadowed = 0;  ///< lit points that get no light
};

/// Both a mirror and clear, so that each hit has two children: outside and straight on inside.
Material mirror_and_glass() {
    Material material;
    material.diffuse = material.reflection = material.transmission = vec3(0.5F);
    return material;
}

/// Rays at the object from outside, a few from within.
std::vector<TestRay> camera_rays(Random& random, const Object& object, std::size_t count) {
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const double far = (i % 4 == 0 ? 0 : std::pow(10.0, uniform(random, 0.5, 3))) * object.size;
        const vec3 aim(object.center + (i % 4 == 0 ? 0.1 : 0.9) * object.size * in_ball(random));
        const vec3 origin(dvec3(aim) + far * unit_vector(random));
        const dvec3 direction = far > 0 ? glm::normalize(dvec3(aim) - dvec3(origin)) : unit_vector(random);
        rays.push_back({origin, vec3(direction), SAHL_NO_PRIMITIVE});
    }
    return rays;
}

void trace(RayTracer& tracer, Random& random, const Object& object, std::size_t count, SelfHitScore& score) {
    const oracle::Oracle oracle(object.scene);
    const DeviceScene scene = tracer.upload(object.scene);
    const std::vector<TestRay> rays = camera_rays(random, object, count);
    const std::vector<TestHit> hits = tracer.intersect(scene, rays);
    const std::vector<TestSurface> surfaces = tracer.surfaces(scene, rays, hits);
    const std::vector<TestSpawn> spawned = tracer.shade(scene, rays, hits);
    std::vector<TestRay> children;
    std::vector<std::size_t> parents;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit()) continue;
        ++score.hits;
        REQUIRE((spawned[i].reflects && spawned[i].transmits));
        for (const TestRay& child : {spawned[i].reflected, spawned[i].transmitted}) {
            children.push_back(child);
            parents.push_back(i);
        }
        // The light is outside: it shines on points whose outer side faces it.
        const vec3 to_light = vec3(object.scene.lights[0].position - surfaces[i].position);
        const bool from_outside = glm::dot(dvec3(rays[i].direction), surfaces[i].ng) < 0;
        if (!from_outside || glm::dot(dvec3(to_light), surfaces[i].ng) <= 0) continue;
        // A light within the rounding of the surface's plane may be behind its neighbours'.
        const double cosine = glm::dot(glm::normalize(dvec3(to_light)), surfaces[i].ng);
        if (cosine < 4 * static_cast<double>(surfaces[i].offset) / object.size) continue;
        ++score.lit;
        score.shadowed += spawned[i].arrived < 0.99F * spawned[i].unshadowed;
    }
    const std::vector<TestHit> next = tracer.intersect(scene, children);
    for (std::size_t k = 0; k < children.size(); ++k) {
        ++score.children;
        const TestSurface& surface = surfaces[parents[k]];
        const double steepness = glm::dot(dvec3(children[k].direction), surface.ng);
        // What is plainly right needs no oracle: nothing met outside, something met well inside.
        const double t = next[k].hit() ? static_cast<double>(next[k].t) : oracle::infinity;
        if (steepness > 0 ? !next[k].hit() : t > 0.1 * object.size && next[k].hit()) continue;
        // Chords shorter than what rays are moved off the surface are not seen, nor edges closer than that.
        const double blur = 4 * static_cast<double>(surface.offset) / std::max(std::abs(steepness), 1e-9);
        if (blur > object.size) continue;
        const oracle::Ray exact{surface.position, dvec3(children[k].direction)};
        const auto wanted = oracle.closest_hit(exact, 1e-6 * object.size, oracle::infinity,
                                               {children[k].exclude, children[k].exclude_instance});
        if (next[k].hit() && t < 0.5 * (wanted ? wanted->t : oracle::infinity)) {
            const bool itself =
                next[k].primitive == children[k].exclude && next[k].instance == children[k].exclude_instance;
            // Of another face of a solid, too, within what rays are moved.
            const bool near_rim = wanted ? wanted->edge_distance * object.size < 4 * blur
                                         // Inside, and out at once: only a ray from a rim is.
                                         : steepness < 0 && t < blur;
            const bool on_edge = itself ? near_rim : t < blur;
            score.edge_hits += on_edge;
            const bool self_hit = !on_edge && (!wanted || wanted->t > blur);
            if (self_hit && ++score.self_hits <= 3)
                UNSCOPED_INFO("met at " << t << ", oracle at " << (wanted ? wanted->t : oracle::infinity)
                                        << ", rim within " << (wanted ? wanted->edge_distance : 0)
                                        << ", steepness " << steepness << ", blur " << blur);
        } else if (!next[k].hit() && wanted) {
            score.leaks += wanted->t > blur && wanted->edge_distance * object.size > 4 * blur;
        }
    }
}

struct StartPlace {
    double size, offset;
};

std::vector<Object> objects(Random& random, const StartPlace& place) {
    const dvec3 center(vec3(place.offset * unit_vector(random)));
    const double size = static_cast<double>(static_cast<float>(place.size));
    const Material material = mirror_and_glass();
    glm::dmat4 squeeze(random_linear(random));
    squeeze[3] = glm::dvec4(center, 1);
    std::vector<Object> result;
    const auto add = [&](const std::string& name) -> Scene& {
        result.push_back({name, {}, center, size});
        return result.back().scene;
    };
    oracle::add_sphere(add("sphere"), {center, size}, material);
    oracle::add_sphere(add("ellipsoid"), {{0, 0, 0}, size}, material, squeeze);
    oracle::add_box(add("box"), {dvec3(vec3(center - size)), dvec3(vec3(center + 0.7 * size))}, material);
    oracle::add_box(add("oblique box"), {dvec3(-0.7 * size), dvec3(0.8, 0.6, 0.7) * size}, material, squeeze);
    const dvec3 axis = size * unit_vector(random);
    oracle::add_cone(add("cylinder"), {center - axis, center + axis, size, size}, material);
    oracle::add_cone(add("cone"), {center - axis, center + axis, 1.5 * size, 0}, material);
    oracle::add_cone(add("solid cylinder"), {center - axis, center + axis, size, size, true}, material);
    oracle::add_cone(add("solid cone"), {center - axis, center + axis, 0.3 * size, 1.5 * size, true},
                     material);
    // Of unit size in their groups, one of these placed by two transforms.
    glm::dmat4 placement = squeeze;
    for (int k = 0; k < 3; ++k) placement[k] *= size;
    const auto add_placed = [&](const std::string& name, const auto& add_to, bool nested) {
        Scene& scene = add(name);
        const std::uint32_t group = oracle::add_group(scene);
        add_to(scene);
        if (!nested) return oracle::add_instance(scene, group, placement);
        const std::uint32_t nest = oracle::add_group(scene);
        const glm::dmat4 inner(random_linear(random));
        oracle::add_instance(scene, nest, group, inner);
        oracle::add_instance(scene, nest, placement * glm::inverse(inner));
    };
    const auto add_ball = [&](Scene& scene) { oracle::add_sphere(scene, {{0, 0, 0}, 1}, material); };
    const auto add_brick = [&](Scene& scene) { oracle::add_box(scene, {dvec3(-0.8), dvec3(0.7)}, material); };
    const auto add_drum = [&](Scene& scene) {
        oracle::add_cone(scene, {{0, 0, -1}, {0, 0.1, 1}, 1, 0.8, true}, material);
    };
    const auto add_facets = [&](Scene& scene) {
        const Scene mesh = icosphere(random, 2, 1, 0, dvec3(0)).scene();
        scene.vertices = mesh.vertices;
        scene.triangles = mesh.triangles;
        scene.primitives = mesh.primitives;
        scene.materials = {material};
        scene.groups.back().primitive_count = static_cast<std::uint32_t>(mesh.primitives.size());
    };
    add_placed("instance of a sphere", add_ball, false);
    add_placed("instance of a box", add_brick, false);
    add_placed("nested instance of a solid cone", add_drum, true);
    add_placed("nested instance of triangles", add_facets, true);
    const auto add_mesh = [&](const std::string& name, const ClosedMesh& mesh) {
        Scene& scene = add(name);
        scene = mesh.scene();
        scene.materials = {material};
    };
    add_mesh("triangles", icosphere(random, 2, size, 0, center));
    add_mesh("quadrangles", quadrangle_cube(random, 3, size, center));
    add_mesh("concave polygons", zigzag_cube(random, size, center));
    for (Object& object : result)
        object.scene.lights = {oracle::point_light(object.center + 30.0 * size * unit_vector(random))};
    return result;
}

}  // namespace

TEST_CASE("no ray meets the surface that it starts on, at scales of 1e-3 to 1e3 and offsets up to 1e6") {
    RayTracer tracer;
    Random random(41);
    SelfHitScore score;
    const std::size_t rays = full_tests() ? 200'000 : 12'000;
    for (const StartPlace& place :
         std::vector<StartPlace>{{1, 0}, {1e-3, 0}, {1e3, 0}, {1, 1e3}, {1e-3, 1}, {1e3, 1e6}, {100, 1e6}}) {
        for (const Object& object : objects(random, place)) {
            CAPTURE(object.name, place.size, place.offset);
            SelfHitScore here;
            trace(tracer, random, object, rays, here);
            CAPTURE(here.hits, here.lit, here.children);
            CHECK(here.self_hits == 0);
            CHECK(here.edge_hits <= here.children / 5000);
            CHECK(here.leaks == 0);
            CHECK(here.shadowed == 0);
            CHECK(here.hits > static_cast<int>(rays) / 4);
            score.children += here.children;
            score.hits += here.hits;
            score.lit += here.lit;
        }
    }
    CHECK(score.children > 500'000);
    CHECK(score.lit > score.hits / 5);
}

}  // namespace sahl::tests
