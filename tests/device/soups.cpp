#include "tests/device/soups.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "tests/support/oracle/build_scene.h"

namespace sahl::tests {

using glm::dvec3;
using glm::vec3;

Soup random_soup(Random& random, int count, double size, double offset) {
    Soup soup;
    const dvec3 center(vec3(offset * unit_vector(random)));
    for (int i = 0; i < count; ++i) {
        const auto kind = static_cast<ShapeKind>(i % 6);
        const dvec3 at(vec3(center + 4 * size * in_ball(random)));
        const bool transformed = uniform(random, 0, 1) < 0.5;
        Material material;
        if (uniform(random, 0, 1) < 0.3) material.transmission = vec3(0.5F);
        soup.targets.push_back(add_random_shape(soup.scene, random, kind, at, size, transformed, material));
        if (i % 8 == 0) {
            soup.scene.primitives.push_back(soup.scene.primitives.back());
            soup.targets.push_back(soup.targets.back());
            ++soup.targets.back().id;
        }
    }
    return soup;
}

Soup axis_parallel_soup(Random& random, int count) {
    Soup soup;
    for (int i = 0; i < count; ++i) {
        const int axis = static_cast<int>(uniform(random, 0, 3));
        vec3 corner, u(0), v(0);
        for (int k = 0; k < 3; ++k) corner[k] = static_cast<float>(std::floor(uniform(random, -4, 4)));
        u[(axis + 1) % 3] = static_cast<float>(std::floor(uniform(random, 1, 3)));
        v[(axis + 2) % 3] = static_cast<float>(std::floor(uniform(random, 1, 3)));
        Target target;
        target.center = dvec3(corner) + 0.5 * dvec3(u + v);
        target.size = glm::length(dvec3(u + v)) / 2;
        dvec3 normal(0);
        normal[axis] = 1;
        for (const vec3& p :
             {corner, corner + u, corner + u + v, corner + v, corner + u * 0.5F, corner + (u + v) * 0.5F})
            target.points.push_back({dvec3(p), normal});
        const auto add = [&](std::uint32_t id) {
            target.id = id;
            soup.targets.push_back(target);
        };
        if (i % 3 != 0)
            add(oracle::add_polygon(soup.scene, {corner, corner + u, corner + u + v, corner + v}, {}));
        if (i % 3 != 1) {
            add(oracle::add_triangle(soup.scene, {corner, corner + u, corner + u + v}, {}));
            add(oracle::add_triangle(soup.scene, {corner, corner + u + v, corner + v}, {}));
        }
    }
    return soup;
}

std::vector<TestRay> random_rays(Random& random, const Soup& soup, std::size_t count) {
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back(random_ray(random, soup.targets[i % soup.targets.size()]));
    return rays;
}

}  // namespace sahl::tests
