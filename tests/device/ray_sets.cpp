#include "tests/device/ray_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

/// The i-th of the targets in runs of 40, so that neighbours in a packet are alike.
const Target& target_of(const Soup& soup, std::size_t i) {
    return soup.targets[i / 40 % soup.targets.size()];
}

const Target::Point& point_of(Random& random, const Target& target) {
    const auto points = static_cast<double>(target.points.size());
    return target.points[static_cast<std::size_t>(uniform(random, 0, points))];
}

TestRay towards(const vec3& from, const dvec3& aim) { return {from, vec3(aim - dvec3(from))}; }

/// A pinhole camera's, pixel by pixel; directions of any length.
TestRay camera_ray(const vec3& eye, const Surroundings& place, std::size_t i, std::size_t count) {
    const auto width = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
    const auto share = [&](std::size_t pixel) {
        return 2 * (static_cast<double>(pixel) + 0.5) / static_cast<double>(width) - 1;
    };
    const dvec3 forward = place.center - dvec3(eye);
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0.1, 0.2, 1)));
    const dvec3 up = glm::normalize(glm::cross(right, forward));
    return towards(eye,
                   place.center + 0.6 * place.radius * (share(i % width) * right + share(i / width) * up));
}

/// Along one axis, exactly, from a lattice of origins or over a point of the target.
TestRay axis_ray(Random& random, const Surroundings& place, const Target& target, int axis) {
    dvec3 origin = place.center + place.radius * in_ball(random);
    if (uniform(random, 0, 1) < 0.5) origin = point_of(random, target).position;
    if (uniform(random, 0, 1) < 0.3) origin = glm::floor(origin);
    const double sign = uniform(random, 0, 1) < 0.8 ? 1 : -1;
    origin[axis] = place.center[axis] - 2 * sign * place.radius;
    TestRay ray{vec3(origin), vec3(0)};
    for (int k = 0; k < 3; ++k) ray.direction[k] = uniform(random, 0, 1) < 0.5 ? 0.0F : -0.0F;
    ray.direction[axis] = static_cast<float>(sign);
    return ray;
}

/// Through a point of the target in its tangent plane.
TestRay grazing_ray(Random& random, const Target& target) {
    const Target::Point& point = point_of(random, target);
    dvec3 along = unit_vector(random);
    along = glm::normalize(along - glm::dot(along, point.normal) * point.normal);
    return towards(vec3(point.position - 3 * target.size * along), point.position);
}

TestRay leaving_ray(Random& random, const Target& target) {
    const Target::Point& point = point_of(random, target);
    return {vec3(point.position), vec3(glm::normalize(point.normal + 0.99 * unit_vector(random))), target.id,
            target.instance};
}

TestRay octant_ray(Random& random, const Surroundings& place, std::size_t octant) {
    dvec3 direction = glm::abs(unit_vector(random));
    for (std::size_t k = 0; k < 3; ++k) {
        if (octant >> k & 1U) direction[static_cast<int>(k)] *= -1;
    }
    return {vec3(place.center + 0.3 * place.radius * in_ball(random)), vec3(direction)};
}

/// As random_rays(), from no further away of any shape that may be in between than what hit.h says.
std::vector<TestRay> mixed_rays(Random& random, const Soup& soup, std::size_t count) {
    std::vector<TestRay> rays;
    while (rays.size() < count) {
        const TestRay ray = random_ray(random, soup.targets[rays.size() % soup.targets.size()]);
        const auto is_near = [&](const Target& target) {
            return target.flat || reach_of(ray, target) * target.condition < 1.1e4 * target.size;
        };
        if (std::all_of(soup.targets.begin(), soup.targets.end(), is_near)) rays.push_back(ray);
    }
    return rays;
}

}  // namespace

Surroundings surroundings(const Soup& soup) {
    Surroundings place;
    for (const Target& target : soup.targets)
        place.center += target.center / static_cast<double>(soup.targets.size());
    for (const Target& target : soup.targets)
        place.radius = std::max(place.radius, glm::distance(place.center, target.center) + target.size);
    return place;
}

std::vector<RaySet> ray_sets(Random& random, const Soup& soup, std::size_t count) {
    const Surroundings place = surroundings(soup);
    const vec3 eye(place.center + 1.8 * place.radius * unit_vector(random));
    const int axis = static_cast<int>(uniform(random, 0, 3));
    std::vector<RaySet> sets{{"camera", {}},        {"features", {}}, {"axis", {}}, {"grazing", {}},
                             {"from surfaces", {}}, {"octants", {}},  {"mixed", {}}};
    for (std::size_t i = 0; i < count; ++i) {
        const Target& target = target_of(soup, i);
        sets[0].rays.push_back(camera_ray(eye, place, i, count));
        sets[1].rays.push_back(towards(eye, i % 4 == 0 ? target.center : point_of(random, target).position));
        sets[2].rays.push_back(axis_ray(random, place, target, axis));
        sets[3].rays.push_back(grazing_ray(random, target));
        sets[4].rays.push_back(leaving_ray(random, target));
        sets[5].rays.push_back(octant_ray(random, place, i % 8));
    }
    sets[6].rays = mixed_rays(random, soup, count);
    return sets;
}

std::vector<TestRay> bad_rays() {
    std::vector<TestRay> rays;
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        for (int k = 0; k < 3; ++k) {
            vec3 v(0.25F, -0.5F, 1);
            v[k] = bad;
            rays.push_back({v, {0, 0, 1}});
            rays.push_back({{0, 0, -9}, v});
            rays.push_back({v, v});
            v[(k + 1) % 3] = -bad;
            rays.push_back({v, {0, 0, 1}});
            rays.push_back({{0, 0, -9}, v});
        }
    }
    rays.push_back({{0, 0, -9}, {0, 0, 0}});
    rays.push_back({{0, 0, -9}, {0, -0.0F, 0}});
    return rays;
}

}  // namespace sahl::tests
