#include "tests/device/soups.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "engine/oracle/build_scene.h"

namespace sahl::tests {

using glm::dvec3;
using glm::vec3;

Soup random_soup(Random& random, int count, double size, double offset) {
    Soup soup;
    const dvec3 center(vec3(offset * unit_vector(random)));
    for (int i = 0; i < count; ++i) {
        const auto kind = static_cast<ShapeKind>(i % shape_kind_count);
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

Soup instanced_soup(Random& random, double size, double offset, double unit, double flatness) {
    Soup soup;
    Scene& scene = soup.scene;
    const dvec3 center(vec3(offset * unit_vector(random)));
    std::vector<Target> own;  // by primitive, in the space of its group
    const auto add_shapes = [&](int first, int count, const dvec3& about, double shape_size) {
        for (int i = first; i < first + count; ++i) {
            Material material;
            if (uniform(random, 0, 1) < 0.3) material.transmission = vec3(0.5F);
            const dvec3 at(vec3(about + 2 * shape_size * in_ball(random)));
            own.push_back(add_random_shape(scene, random, static_cast<ShapeKind>(i % shape_kind_count), at,
                                           shape_size, uniform(random, 0, 1) < 0.5, material));
        }
    };
    const auto somewhere = [&](double scale, const dvec3& about, double reach) {
        glm::dmat4 transform(random_linear(random) * scale);
        transform[3] = glm::dvec4(about + reach * in_ball(random), 1);
        return transform;
    };
    add_shapes(0, 6, center, size);
    const std::uint32_t low = oracle::add_group(scene);
    add_shapes(0, 7, dvec3(0), unit);
    const std::uint32_t high = oracle::add_group(scene);
    add_shapes(7, 6, dvec3(3, -2, 1) / unit, 0.5 / unit);
    const std::uint32_t nest = oracle::add_group(scene);
    oracle::add_instance(scene, nest, low, somewhere(0.7 / unit, dvec3(0), 2));
    oracle::add_instance(scene, nest, high, somewhere(unit, dvec3(0), 2));
    const std::uint32_t outer = oracle::add_group(scene);
    add_shapes(13, 2, dvec3(0), 1);
    oracle::add_instance(scene, outer, nest, somewhere(0.7, dvec3(0), 2));
    for (const std::uint32_t group : {low, high, nest, outer, low, outer}) {
        const double scale = group == low ? size / unit : group == high ? size * unit : size;
        glm::dmat4 transform = somewhere(scale, center, 4 * size);
        transform[static_cast<int>(group) % 3] /= flatness;
        oracle::add_instance(scene, group, transform);
    }
    scene.instances.push_back(scene.instances.front());

    const std::vector<glm::dmat4> placements = oracle::instance_placements(scene);
    for (const oracle::PlacedShape& shape : oracle::place_shapes(scene)) {
        const Target& target = own[shape.primitive];
        soup.targets.push_back(
            shape.instance == 0 ? target : placed(target, placements[shape.instance - 1], shape.instance));
    }
    return soup;
}

Soup without_instances(const Soup& soup) {
    Soup baked = soup;
    baked.scene.primitives.clear();
    baked.scene.groups.clear();
    baked.scene.instances.clear();
    const std::vector<glm::dmat4> placements = oracle::instance_placements(soup.scene);
    for (Target& target : baked.targets) {
        Primitive primitive = soup.scene.primitives[target.id];
        if (target.instance != 0) {
            baked.scene.transforms.push_back(placements[target.instance - 1] *
                                             soup.scene.transforms[primitive.transform]);
            primitive.transform = static_cast<std::uint32_t>(baked.scene.transforms.size() - 1);
        }
        target.id = static_cast<std::uint32_t>(baked.scene.primitives.size());
        target.instance = 0;
        baked.scene.primitives.push_back(primitive);
    }
    return baked;
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
        target.flat = true;
        for (std::size_t tip = 0; tip < 4; ++tip) target.tips.push_back(target.points[tip].position);
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
