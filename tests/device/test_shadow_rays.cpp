// Shadow rays by all ways of traversal in all versions of kernels/simd.h (RayTracer compares them): the same
// light, bit for bit, and the oracle's. What is between surfaces and lights is opaque, clear, one-sided,
// instanced.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"
#include "tests/device/ray_sets.h"
#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::size_t light_count = 3;

/// A light in the middle of the soup, which sends rays into all octants, one beside it and a far one. Each
/// has a channel of its own in what arrives.
void add_lights(Soup& soup) {
    const Surroundings place = surroundings(soup);
    // Positions are floats, so that the device has them exactly.
    soup.scene.lights = {oracle::point_light(dvec3(vec3(place.center))),
                         oracle::point_light(dvec3(vec3(place.center + place.radius * dvec3(0.9, -1.3, 2)))),
                         oracle::directional_light(dvec3(vec3(0.25, -0.5, 0.75)))};
}

vec3 channel(std::size_t light) {
    vec3 color(0);
    color[static_cast<int>(light)] = 1;
    return color;
}

std::vector<vec3> one_channel_each(std::size_t points) {
    std::vector<vec3> brought;
    for (std::size_t light = 0; light < light_count; ++light)
        brought.insert(brought.end(), points, channel(light));
    return brought;
}

/// Points in a plane through the soup, neighbours beside each other; points on its surfaces; points anywhere.
std::vector<TestLitPoint> lit_points(Random& random, const Soup& soup, std::size_t count) {
    const Surroundings place = surroundings(soup);
    const dvec3 u = place.radius * unit_vector(random);
    const dvec3 v = place.radius * glm::normalize(glm::cross(u, unit_vector(random)));
    std::vector<TestLitPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double s = static_cast<double>(i % 64) / 32 - 1;
        const double t = static_cast<double>(i) / static_cast<double>(count) * 2 - 1;
        points.push_back({vec3(place.center + s * u + t * v)});
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Target& target = soup.targets[i % soup.targets.size()];
        const auto& surface_points = target.points;
        points.push_back({vec3(surface_points[i / soup.targets.size() % surface_points.size()].position),
                          target.id, target.instance});
    }
    for (std::size_t i = 0; i < count; ++i)
        points.push_back({vec3(place.center + place.radius * in_ball(random))});
    return points;
}

/// Whether the point is the apex of the surface that it is on, as a float has it: a line through there meets
/// the cone twice at once, or just not.
bool is_apex(const Soup& soup, const TestLitPoint& point, double size) {
    return std::any_of(soup.targets.begin(), soup.targets.end(), [&](const Target& target) {
        return target.id == point.exclude && target.instance == point.exclude_instance && !target.flat &&
               std::any_of(target.tips.begin(), target.tips.end(), [&](const dvec3& tip) {
                   return glm::distance(tip, dvec3(point.position)) < 1e-6 * size;
               });
    });
}

/// What light `light` sends to `point` according to the oracle; negative where single precision may see
/// something else.
double expected(const oracle::Oracle& oracle, const std::vector<oracle::PlacedShape>& shapes,
                const TestLitPoint& point, std::size_t light, double size) {
    const Light& lamp = oracle.scene().lights[light];
    const bool far = lamp.kind == LightKind::directional;
    const dvec3 origin(point.position);
    const oracle::Ray ray{origin, far ? lamp.position : lamp.position - origin};
    const double t_max = far ? oracle::infinity : 1;
    const oracle::SurfaceId start{point.exclude, point.exclude_instance};
    const double near = 1e-4 * size / glm::length(ray.direction);
    for (const oracle::PlacedShape& placed : shapes) {
        const bool starts_here = oracle::SurfaceId{placed.primitive, placed.instance} == start;
        const oracle::Crossings crossings = placed.shape.cross(ray, starts_here);
        if (crossings.margin < 1e-3) return -1;
        for (int i = 0; i < crossings.count; ++i) {
            if (std::abs(crossings.at[i].t) < near || std::abs(crossings.at[i].t - t_max) < near) return -1;
        }
    }
    int crossed = 0;
    return oracle.transmittance(ray, t_max, start, crossed).x;
}

}  // namespace

TEST_CASE("shadow rays of every traversal let the same light through, and the oracle's") {
    RayTracer tracer;
    Random random(81);
    int compared = 0, dark = 0, dimmed = 0;
    for (int round = 0; round < (full_tests() ? 40 : 1); ++round) {
        std::vector<std::pair<std::string, Soup>> soups;
        soups.emplace_back("crowd", random_soup(random, 40, 1, 0));
        soups.emplace_back("sparse crowd", random_soup(random, 10, 1, 0));
        soups.emplace_back("instances", instanced_soup(random, 1, 0));
        soups.emplace_back("large instances far away", instanced_soup(random, 1e3, 1e5));
        soups.emplace_back("walls", axis_parallel_soup(random, 60));
        for (auto& [name, soup] : soups) {
            CAPTURE(name);
            add_lights(soup);
            const std::vector<TestLitPoint> points = lit_points(random, soup, 1500);
            const std::vector<vec3> light =
                tracer.arriving(tracer.upload(soup.scene), points, one_channel_each(points.size()));
            const oracle::Oracle oracle(soup.scene);
            const std::vector<oracle::PlacedShape> shapes = oracle::place_shapes(soup.scene);
            const double size = surroundings(soup).radius;
            // Far away single precision places points too roughly.
            if (name == "large instances far away") continue;
            for (std::size_t i = 0; i < points.size(); i += 7) {
                if (is_apex(soup, points[i], size)) continue;
                for (std::size_t l = 0; l < light_count; ++l) {
                    const double wanted = expected(oracle, shapes, points[i], l, size);
                    if (wanted < 0) continue;
                    ++compared;
                    dark += wanted == 0;
                    dimmed += wanted > 0 && wanted < 1;
                    CAPTURE(i, l);
                    CHECK(static_cast<double>(light[i][static_cast<int>(l)]) == wanted);
                }
            }
        }
    }
    CHECK(compared > 3000);
    CHECK(dark > 500);
    CHECK(dimmed > 20);
}

TEST_CASE("shadow rays pass more transparent surfaces than fit into a list, in either order, each once") {
    // 21 sheets that let different powers of two through, so that products are exact, and a light above.
    // Points are below all of them, or have the first k above them.
    constexpr int sheets = 21;
    RayTracer tracer;
    Scene scene;
    for (int k = 0; k < sheets; ++k) {
        const int place = k * 8 % sheets;  // ids are in another order
        oracle::add_square(scene, static_cast<float>(place + 1), 4,
                           oracle::glass(vec3(std::ldexp(1.0F, -(place % 3))), 1));
    }
    const float top = sheets + 2;
    scene.lights = {oracle::point_light(dvec3(0.125, 0.25, top)), oracle::directional_light(dvec3(0, 0, 1)),
                    oracle::point_light(dvec3(0.125, 0.25, top))};
    std::vector<TestLitPoint> points;
    std::vector<float> wanted;
    for (int i = 0; i < 700; ++i) {
        const int above = i % (sheets + 1);
        const float z = static_cast<float>(sheets - above) + 0.5F;
        points.push_back({vec3(static_cast<float>(i % 7) / 4 - 1, static_cast<float>(i % 11) / 8 - 1, z)});
        int halvings = 0;
        for (int place = sheets - above; place < sheets; ++place) halvings += place % 3;
        wanted.push_back(std::ldexp(1.0F, -halvings));
    }
    const std::vector<vec3> got =
        tracer.arriving(tracer.upload(scene), points, one_channel_each(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        CAPTURE(i);
        REQUIRE(got[i] == vec3(wanted[i]));
    }
    // From above downwards.
    scene.lights = {oracle::point_light(dvec3(0.125, 0.25, 0)), oracle::directional_light(dvec3(0, 0, -1)),
                    oracle::point_light(dvec3(0.125, 0.25, 0))};
    for (std::size_t i = 0; i < points.size(); ++i) points[i].position.z = top;
    const vec3 all(std::ldexp(1.0F, -sheets));  // 7 times 0 + 1 + 2
    for (const vec3& light : tracer.arriving(tracer.upload(scene), points, one_channel_each(points.size())))
        REQUIRE(light == all);
}

TEST_CASE("shadow rays: batches of any size, points without lamps, and lights that bring nothing") {
    RayTracer tracer;
    Random random(82);
    Soup soup = random_soup(random, 20, 1, 0);
    add_lights(soup);
    const DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<TestLitPoint> all = lit_points(random, soup, 700);
    const std::vector<vec3> alone = tracer.arriving(scene, all, one_channel_each(all.size()));
    for (const std::size_t count :
         {0U,  1U,  3U,  7U,  8U,  9U,   17U,  20U,  21U,  28U,  29U,  32U,   33U,
          40U, 41U, 63U, 64U, 65U, 127U, 128U, 129U, 255U, 256U, 257U, 1023U, 1025U}) {
        CAPTURE(count);
        std::vector<TestLitPoint> points(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
        std::vector<vec3> brought = one_channel_each(count);
        std::vector<vec3> wanted(alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(count));
        for (std::size_t i = 0; i < count; ++i) {
            if (i % 5 == 2) {
                points[i].has_shadow_rays = false;
                wanted[i] = vec3(0);
            }
            if (i % 3 == 1) {
                brought[i % light_count * count + i] = vec3(0);
                wanted[i] *= vec3(1) - channel(i % light_count);
            }
        }
        CHECK(tracer.arriving(scene, points, brought) == wanted);
    }
}

TEST_CASE("shadow rays that lead nowhere meet nothing and do not disturb their neighbours") {
    RayTracer tracer;
    Random random(83);
    Soup soup = instanced_soup(random, 1, 0);
    add_lights(soup);
    const DeviceScene scene = tracer.upload(soup.scene);
    std::vector<TestLitPoint> points = lit_points(random, soup, 500);
    const std::vector<vec3> brought = one_channel_each(points.size());
    std::vector<vec3> wanted = tracer.arriving(scene, points, brought);
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const vec3 lamp(soup.scene.lights[0].position);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % 6 != 1 && i / 16 % 5 != 2) continue;
        if (i % 4 == 0) {
            // The first light's direction is 0 there; the others shine as they do.
            points[i] = {lamp};
            const std::vector<vec3> here = tracer.arriving(scene, {points[i]}, one_channel_each(1));
            CHECK(here[0].x == 1);
            wanted[i] = here[0];
        } else {
            points[i] = {vec3(1, 2, 3)};
            points[i].position[static_cast<int>(i % 3)] = i % 4 == 1   ? nan
                                                          : i % 4 == 2 ? infinity
                                                                       : -infinity;
            wanted[i] = vec3(1);
        }
    }
    CHECK(tracer.arriving(scene, points, brought) == wanted);
}

TEST_CASE("shadow rays meet what a walk meets before their end, at 0, behind or nowhere too") {
    RayTracer tracer;
    Random random(85);
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> nowhere{0, -0.0F, -1, -infinity, std::numeric_limits<float>::quiet_NaN()};
    std::size_t between = 0, ends = 0;
    for (const bool instanced : {false, true}) {
        const Soup soup = instanced ? instanced_soup(random, 1, 0) : random_soup(random, 40, 1, 0);
        const DeviceScene scene = tracer.upload(soup.scene);
        for (const auto& [name, rays] : ray_sets(random, soup, 1500)) {
            CAPTURE(instanced, name);
            const std::vector<TestWalk> walks = tracer.walk(scene, rays, infinity);
            std::vector<float> t_max;
            std::vector<Occlusion> wanted;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                // Before all; at a crossing, which is left out; a bit beyond it. Not at the last that a walk
                // has room for, as there may be more.
                const std::uint32_t count = std::min(walks[i].count, TestWalk::longest - 1);
                const float at = walks[i].t[count > 0 ? i % count : 0];
                t_max.push_back(i % 3 == 0 || count == 0 ? nowhere[i / 3 % nowhere.size()]
                                : i % 3 == 1             ? at
                                                         : std::nextafter(at, infinity));
                Occlusion met = Occlusion::nothing;
                for (std::uint32_t k = 0; k < walks[i].count && walks[i].t[k] < t_max[i]; ++k) {
                    const Primitive& primitive = soup.scene.primitives[walks[i].primitives[k]];
                    const bool clear = soup.scene.materials[primitive.material].transmission != vec3(0);
                    met = std::max(met, clear ? Occlusion::transparent : Occlusion::opaque);
                }
                wanted.push_back(met);
                between += met != Occlusion::nothing;
                ends += i % 3 == 1 && count > 0;
            }
            CHECK(tracer.occlusion(scene, rays, t_max) == wanted);
        }
        for (const float end : nowhere) {
            for (const TestWalk& walk : tracer.walk(scene, ray_sets(random, soup, 200)[0].rays, end))
                CHECK(walk.count == 0);
        }
    }
    CHECK(between > 4000);
    CHECK(ends > 3000);
}

TEST_CASE("lights of all kinds add up in their order, on top of what has arrived") {
    RayTracer tracer;
    Random random(84);
    Soup soup = random_soup(random, 12, 1, 0);
    add_lights(soup);
    soup.scene.lights.push_back(oracle::spot_light({5, 5, 5}, {-1, -1, -1}, 20, 40));
    for (int i = 0; i < 8; ++i)
        soup.scene.lights.push_back(i % 2 == 0 ? oracle::directional_light(unit_vector(random))
                                               : oracle::point_light(6.0 * unit_vector(random)));
    const std::vector<TestLitPoint> points = lit_points(random, soup, 700);
    const std::size_t lights = soup.scene.lights.size();
    std::vector<vec3> brought;
    for (std::size_t i = 0; i < lights * points.size(); ++i) {
        const bool nothing = uniform(random, 0, 1) < 0.3;
        brought.push_back(nothing ? vec3(0) : vec3(unit_vector(random)));
    }
    const DeviceScene scene = tracer.upload(soup.scene);
    const std::vector<vec3> together = tracer.arriving(scene, points, brought);
    // One at a time, added on the host in the same order.
    std::vector<vec3> sums(points.size(), vec3(0));
    for (std::size_t l = 0; l < lights; ++l) {
        std::vector<vec3> one(brought.size(), vec3(0));
        const auto first = static_cast<std::ptrdiff_t>(l * points.size());
        const auto last = first + static_cast<std::ptrdiff_t>(points.size());
        std::copy(brought.begin() + first, brought.begin() + last, one.begin() + first);
        const std::vector<vec3> light = tracer.arriving(scene, points, one);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += light[i];
    }
    CHECK(together == sums);
}

}  // namespace sahl::tests
