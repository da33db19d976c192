// Each kind of primitive through the engine's intersect kernel, and its surface, against the oracle.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/device/random_shapes.h"
#include "tests/device/ray_verdict.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dvec3;

// Roundings in a row that an intersection amounts to, in units of 2^-24 of the distance (rounding_of()).
constexpr double kPrimitiveRoundings = 8;

struct PrimitivePlace {
    double size, offset;
};

/// Tiny and huge, at the origin and as far as 1e6 away.
const std::vector<PrimitivePlace> kPlaces{{1, 0},    {1e-3, 0},  {1e3, 0},  {1, 1e3},
                                          {1e-3, 1}, {1e3, 1e6}, {100, 1e6}};

struct PrimitiveScore {
    int rays = 0, sure = 0, hits = 0;
    int wrong = 0;           ///< another primitive than the oracle's, or none, or one where there is none
    std::string wrong_rays;  ///< some of them
    int wrong_t = 0;         ///< the right primitive at a wrong distance
    int beside = 0;          ///< a hit that is not at its primitive (for flat ones: in its box)
    double position = 0;     ///< largest error of surface_at(), of what single precision would have
    double ng = 0, ns = 0;
};

/// Errors of the surface at a sure hit. It is computed in double precision along the exact ray, so that only
/// what was rounded on the way to the device is left: nothing of curved shapes, the corners of flat ones.
void compare_surface(const Target& target, const Verdict& verdict, const TestRay& ray, const TestHit& hit,
                     const TestSurface& surface, PrimitiveScore& score) {
    const dvec3 position = dvec3(ray.origin) + verdict.crossing.t * dvec3(ray.direction);
    const double cosine = std::abs(glm::dot(glm::normalize(dvec3(ray.direction)), verdict.crossing.ng));
    const double unit = verdict.rounding / kPrimitiveRoundings / cosine;
    // Where the ray grazes or the target is hardly more than a rounding, the hit may be its other crossing.
    const double apart =
        std::abs(static_cast<double>(hit.t) - verdict.crossing.t) * glm::length(dvec3(ray.direction));
    if (!verdict.one_face || cosine < 0.1 || unit > 1e-3 * target.size || apart > kPrimitiveRoundings * unit)
        return;
    score.position = std::max(score.position, glm::distance(surface.position, position) / unit);
    score.ng = std::max(score.ng, glm::distance(surface.ng, verdict.crossing.ng) * target.size / unit);
    score.ns = std::max(score.ns, glm::distance(surface.ns, verdict.crossing.ns) * target.size / unit);
}

void compare(RayTracer& tracer, ShapeKind kind, Random& random, const PrimitivePlace& place, bool transformed,
             PrimitiveScore& score) {
    Scene scene;
    std::vector<Target> targets;
    const dvec3 center(glm::vec3(place.offset * unit_vector(random)));
    for (int i = 0; i < 5; ++i) {
        const dvec3 near(glm::vec3(center + 2 * place.size * in_ball(random)));
        targets.push_back(add_random_shape(scene, random, kind, near, place.size, transformed));
    }
    const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(scene);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < 500; ++i) rays.push_back(random_ray(random, targets[i % targets.size()]));
    const DeviceScene device_scene = tracer.upload(scene);
    const std::vector<TestHit> hits = tracer.intersect(device_scene, rays);
    const std::vector<TestSurface> surfaces = tracer.surfaces(device_scene, rays, hits);

    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestHit& hit = hits[i];
        const Verdict verdict = judge(shapes, targets, rays[i], kPrimitiveRoundings);
        ++score.rays;
        if (hit.hit()) {
            const Target& target = targets[hit.primitive];
            const dvec3 position =
                dvec3(rays[i].origin) + static_cast<double>(hit.t) * dvec3(rays[i].direction);
            score.beside += glm::distance(position, target.center) >
                            (target.flat ? 1.74 : 1.001) * target.size + 2 * verdict.rounding;
        }
        // From a rim the chord may be shorter than a rounding.
        const double length = static_cast<double>(hit.t) * glm::length(dvec3(rays[i].direction));
        const bool from_rim = hit.hit() && hit.primitive == rays[i].exclude && length < 2 * verdict.rounding;
        if (!verdict.sure || from_rim) continue;
        ++score.sure;
        score.wrong += hit.primitive != verdict.primitive;
        if (hit.primitive != verdict.primitive && score.wrong <= 4) {
            const TestRay& ray = rays[i];
            std::ostringstream text;
            text << std::setprecision(9) << "from " << ray.origin.x << " " << ray.origin.y << " "
                 << ray.origin.z << " along " << ray.direction.x << " " << ray.direction.y << " "
                 << ray.direction.z << " starting on " << ray.exclude << ": " << hit.primitive << " at "
                 << hit.t << ", oracle " << verdict.primitive << " at " << verdict.crossing.t
                 << (transformed ? ", transformed; " : "; ");
            score.wrong_rays += text.str();
        }
        if (!hit.hit() || hit.primitive != verdict.primitive) continue;
        ++score.hits;
        const double t = static_cast<double>(hit.t), slack = 4 * 0x1p-24 * t;
        score.wrong_t += t < verdict.t_least - slack || t > verdict.t_most + slack;
        compare_surface(targets[hit.primitive], verdict, rays[i], hit, surfaces[i], score);
    }
}

PrimitiveScore compare_all(ShapeKind kind) {
    RayTracer tracer;
    Random random(static_cast<unsigned>(kind) + 1);
    PrimitiveScore score;
    for (int round = 0; round < 4; ++round) {
        for (const PrimitivePlace& place : kPlaces) {
            compare(tracer, kind, random, place, false, score);
            compare(tracer, kind, random, place, true, score);
        }
    }
    return score;
}

void check(ShapeKind kind) {
    const PrimitiveScore score = compare_all(kind);
    CAPTURE(score.rays, score.sure, score.hits, score.position, score.ng, score.ns, score.wrong_rays);
    CHECK(score.sure > 0.6 * score.rays);
    CHECK(score.hits > 0.05 * score.rays);
    // Where a rim meets the silhouette, all moved rays can pass beside what the kernel hits.
    CHECK(score.wrong <= score.rays / 5000);
    CHECK(score.wrong_t == 0);
    CHECK(score.beside == 0);
    const bool flat = kind == ShapeKind::triangle || kind == ShapeKind::polygon;
    CHECK(score.position < (flat ? 8 : 1e-3));
    CHECK(score.ng < (flat ? 32 : 0.1));
    CHECK(score.ns < (flat ? 32 : 0.1));
}

}  // namespace

TEST_CASE("triangles are hit where the oracle says") { check(ShapeKind::triangle); }
TEST_CASE("polygons are hit where the oracle says") { check(ShapeKind::polygon); }
TEST_CASE("spheres are hit where the oracle says") { check(ShapeKind::sphere); }
TEST_CASE("ellipsoids are hit where the oracle says") { check(ShapeKind::ellipsoid); }
TEST_CASE("cones are hit where the oracle says") { check(ShapeKind::cone); }
TEST_CASE("cylinders are hit where the oracle says") { check(ShapeKind::cylinder); }
TEST_CASE("discs are hit where the oracle says") { check(ShapeKind::disc); }
TEST_CASE("boxes are hit where the oracle says") { check(ShapeKind::box); }
TEST_CASE("solid cones are hit where the oracle says") { check(ShapeKind::solid_cone); }
TEST_CASE("solid cylinders are hit where the oracle says") { check(ShapeKind::solid_cylinder); }

}  // namespace sahl::tests
