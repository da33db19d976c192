#include "tests/device/random_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/oracle/build_scene.h"

namespace sahl::tests {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

dmat3 rotation(Random& random) {
    const dvec3 x = unit_vector(random);
    const dvec3 y = glm::normalize(glm::cross(x, unit_vector(random)));
    return {x, y, glm::cross(x, y)};
}

double frobenius(const dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

dmat4 affine(const dmat3& linear, const dvec3& at) {
    dmat4 m(linear);
    m[3] = glm::dvec4(at, 1);
    return m;
}

/// Outline in the plane z = 0 around 0: a star of 3 to 12 corners, most of them concave.
std::vector<dvec3> star(Random& random) {
    const int corners = 3 + static_cast<int>(uniform(random, 0, 10));
    std::vector<dvec3> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * (i + uniform(random, -0.3, 0.3)) / corners;
        const double radius = uniform(random, 0.2, 1);
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return points;
}

/// Shapes in an object space around 0 and the transform to the world, in which all is built.
class Builder {
public:
    Builder(Scene& scene, Random& random, const Material& material)
        : scene_(scene), random_(random), material_(material) {}

    Target add(ShapeKind kind, const dvec3& center, double size, bool transformed) {
        target_.center = center;
        target_.flat = kind == ShapeKind::triangle || kind == ShapeKind::polygon || kind == ShapeKind::disc;
        linear_ = transformed || kind == ShapeKind::ellipsoid ? random_linear(random_) : dmat3(1);
        if (kind == ShapeKind::sphere && transformed) linear_ = rotation(random_) * uniform(random_, 0.5, 2);
        const bool identity = linear_ == dmat3(1);
        world_from_object_ = identity ? dmat4(1) : affine(linear_, center);
        object_center_ = identity ? center : dvec3(0);
        size_ = size;
        switch (kind) {
            case ShapeKind::triangle:
                add_flat({in_ball(random_), in_ball(random_), in_ball(random_)}, true);
                break;
            case ShapeKind::polygon:
                add_flat(star(random_), false);
                break;
            case ShapeKind::sphere:
            case ShapeKind::ellipsoid:
                add_round();
                break;
            case ShapeKind::cone:
            case ShapeKind::solid_cone:
                add_cone(uniform(random_, 0, 1) < 0.3 ? 0 : uniform(random_, 0.1, 1),
                         kind == ShapeKind::solid_cone);
                break;
            case ShapeKind::cylinder:
            case ShapeKind::solid_cylinder:
                add_cone(-1, kind == ShapeKind::solid_cylinder);
                break;
            case ShapeKind::disc:
                add_disc();
                break;
            case ShapeKind::box:
                add_box();
                break;
        }
        scene_.primitives.back().sides = random_sides();
        for (const Target::Point& point : target_.points)
            target_.size = std::max(target_.size, glm::distance(point.position, center));
        return target_;
    }

private:
    void add_point(const dvec3& object, const dvec3& normal) {
        target_.points.push_back({dvec3(world_from_object_ * glm::dvec4(object, 1)),
                                  glm::normalize(glm::transpose(glm::inverse(linear_)) * normal)});
    }

    void set_condition(const dmat3& world_from_unit) {
        target_.condition = frobenius(world_from_unit) * frobenius(glm::inverse(world_from_unit)) / 3;
    }

    void add_flat(const std::vector<dvec3>& outline, bool triangle) {
        const dmat3 turn = rotation(random_);
        std::vector<glm::vec3> corners;
        for (const dvec3& point : outline) corners.emplace_back(object_center_ + size_ * (turn * point));
        if (triangle) {
            std::vector<glm::vec3> normals;
            if (uniform(random_, 0, 1) < 0.5) {
                for (int i = 0; i < 3; ++i)
                    normals.emplace_back(turn * glm::normalize(dvec3(0, 0, 1.1) + in_ball(random_)));
            }
            target_.id = oracle::add_triangle(scene_, corners, material_, world_from_object_, normals);
        } else {
            target_.id = oracle::add_polygon(scene_, corners, material_, world_from_object_);
        }
        dvec3 normal(0);
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            normal +=
                glm::cross(dvec3(corners[i]) - dvec3(corners[0]), dvec3(corners[i + 1]) - dvec3(corners[0]));
        }
        dvec3 middle = object_center_;
        if (triangle) middle = (dvec3(corners[0]) + dvec3(corners[1]) + dvec3(corners[2])) / 3.0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const dvec3 here(corners[i]), next(corners[(i + 1) % corners.size()]);
            add_point(here, normal);
            target_.tips.push_back(target_.points.back().position);
            add_point(here + uniform(random_, 0, 1) * (next - here), normal);
            add_point(middle + uniform(random_, 0, 0.95) * (here - middle), normal);
        }
        target_.size = size_;
    }

    Sides random_sides() {
        const double chance = uniform(random_, 0, 1);
        return chance < 0.2 ? Sides::back : chance < 0.3 ? Sides::front : Sides::both;
    }

    void add_round() {
        Sphere sphere;
        sphere.center = object_center_;
        // Where no transform rounds, the numbers are floats, so that the device has them exactly.
        sphere.radius = static_cast<float>(size_ * uniform(random_, 0.1, 1));
        target_.id = oracle::add_sphere(scene_, sphere, material_, world_from_object_);
        set_condition(linear_);
        for (int i = 0; i < 12; ++i) {
            const dvec3 n = i < 3 ? dvec3(i == 0, i == 1, i == 2) : unit_vector(random_);
            add_point(sphere.center + sphere.radius * n, n);
        }
        target_.size = sphere.radius * frobenius(linear_);
    }

    /// `apex_share` of the base radius; negative: a cylinder.
    void add_cone(double apex_share, bool capped) {
        Cone cone;
        cone.capped = capped;
        const dvec3 axis = unit_vector(random_) * (size_ * uniform(random_, 0.2, 1.5));
        cone.base = object_center_ - 0.5 * axis;
        cone.apex = object_center_ + 0.5 * axis;
        cone.base_radius = size_ * uniform(random_, 0.1, 0.8);
        cone.apex_radius = cone.base_radius * (apex_share < 0 ? 1 : apex_share);
        if (uniform(random_, 0, 1) < 0.5) std::swap(cone.base_radius, cone.apex_radius);
        target_.id = oracle::add_cone(scene_, cone, material_, world_from_object_);
        if (apex_share == 0) {
            const dvec3 apex = cone.apex_radius == 0 ? cone.apex : cone.base;
            target_.tips.emplace_back(world_from_object_ * glm::dvec4(apex, 1));
        }
        const dvec3 unit = glm::normalize(axis);
        const dvec3 x = glm::normalize(glm::cross(unit, unit_vector(random_)));
        const dvec3 y = glm::cross(unit, x);
        const double widest = std::max(cone.base_radius, cone.apex_radius);
        set_condition(linear_ * dmat3(x * widest, y * widest, axis));
        const double slope = (cone.apex_radius - cone.base_radius) / glm::length(axis);
        for (int i = 0; i < 15; ++i) {
            const double height = i < 6 ? i % 2 : uniform(random_, 0, 1);
            const double angle = uniform(random_, 0, 2 * std::numbers::pi);
            const dvec3 out = x * std::cos(angle) + y * std::sin(angle);
            const double radius = cone.base_radius + height * (cone.apex_radius - cone.base_radius);
            add_point(cone.base + height * axis + radius * out, out - slope * unit);
            if (capped && i % 3 == 0) add_point(cone.base + 0.7 * cone.base_radius * out, -unit);
            if (capped && i % 3 == 1) add_point(cone.apex + 0.7 * cone.apex_radius * out, unit);
        }
        target_.size = std::hypot(glm::length(axis) / 2, widest) * frobenius(linear_);
    }

    void add_disc() {
        Disc disc;
        disc.center = object_center_;
        disc.normal = unit_vector(random_) * uniform(random_, 0.1, 10);
        disc.radius = size_ * uniform(random_, 0.1, 1);
        target_.id = oracle::add_disc(scene_, disc, material_, world_from_object_);
        set_condition(linear_);
        const dvec3 unit = glm::normalize(disc.normal);
        const dvec3 x = glm::normalize(glm::cross(unit, unit_vector(random_)));
        const dvec3 y = glm::cross(unit, x);
        for (int i = 0; i < 12; ++i) {
            const double angle = uniform(random_, 0, 2 * std::numbers::pi);
            const double share = i < 5 ? 1 : std::sqrt(uniform(random_, 0, 1));
            add_point(disc.center + disc.radius * share * (x * std::cos(angle) + y * std::sin(angle)), unit);
        }
        target_.size = disc.radius * frobenius(linear_);
    }

    void add_box() {
        dvec3 half;
        for (int k = 0; k < 3; ++k) half[k] = size_ * uniform(random_, 0.1, 0.8);
        // Where no transform rounds, the numbers are floats, so that the device has them exactly.
        const Box box{dvec3(glm::vec3(object_center_ - half)), dvec3(glm::vec3(object_center_ + half))};
        target_.id = oracle::add_box(scene_, box, material_, world_from_object_);
        set_condition(linear_ * dmat3(dvec3(half.x, 0, 0), dvec3(0, half.y, 0), dvec3(0, 0, half.z)));
        for (int i = 0; i < 18; ++i) {
            // On a face; two in three on one of its edges, some at a corner.
            const int axis = i % 3;
            dvec3 share(uniform(random_, 0, 1), uniform(random_, 0, 1), uniform(random_, 0, 1)), normal(0);
            share[axis] = i / 3 % 2;
            normal[axis] = 2 * share[axis] - 1;
            if (i < 12) share[(axis + 1) % 3] = std::round(share[(axis + 1) % 3]);
            if (i < 3) share[(axis + 2) % 3] = std::round(share[(axis + 2) % 3]);
            add_point(box.lo + share * (box.hi - box.lo), normal);
            if (i < 3) target_.tips.push_back(target_.points.back().position);
        }
        target_.size = glm::length(half) * frobenius(linear_);
    }

    Scene& scene_;
    Random& random_;
    Material material_;
    dmat3 linear_{1};
    dmat4 world_from_object_{1};
    dvec3 object_center_{0};
    double size_ = 1;
    Target target_;
};

/// A direction with one or two components of +0 or -0.
dvec3 axis_parallel(Random& random) {
    dvec3 d = unit_vector(random);
    const int first = static_cast<int>(uniform(random, 0, 3));
    d[first] = uniform(random, 0, 1) < 0.5 ? 0.0 : -0.0;
    if (uniform(random, 0, 1) < 0.5) d[(first + 1) % 3] = uniform(random, 0, 1) < 0.5 ? 0.0 : -0.0;
    return d;
}

}  // namespace

double uniform(Random& random, double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

dvec3 in_ball(Random& random) {
    for (;;) {
        const double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, -1, 1);
        if (x * x + y * y + z * z <= 1) return {x, y, z};
    }
}

dvec3 unit_vector(Random& random) {
    for (;;) {
        const dvec3 v = in_ball(random);
        if (glm::dot(v, v) > 1e-4) return glm::normalize(v);
    }
}

dmat3 random_linear(Random& random) {
    dmat3 stretch(1);
    for (int k = 0; k < 3; ++k) stretch[k][k] = std::exp2(uniform(random, -1, 1));
    if (uniform(random, 0, 1) < 0.5) stretch[0][0] = -stretch[0][0];
    dmat3 shear(1);
    shear[1][0] = uniform(random, -0.5, 0.5);
    shear[2][1] = uniform(random, -0.5, 0.5);
    return rotation(random) * stretch * shear * rotation(random);
}

Target add_random_shape(Scene& scene, Random& random, ShapeKind kind, const dvec3& center, double size,
                        bool transformed, const Material& material) {
    return Builder(scene, random, material).add(kind, center, size, transformed);
}

Target placed(const Target& target, const dmat4& world_from_group, std::uint32_t instance) {
    const dmat3 linear(world_from_group);
    const dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
    const auto point = [&](const dvec3& p) { return dvec3(world_from_group * glm::dvec4(p, 1)); };
    Target result = target;
    result.instance = instance;
    result.center = point(target.center);
    result.size = target.size * frobenius(linear);
    const double condition = frobenius(linear) * frobenius(glm::inverse(linear)) / 3;
    result.condition = target.condition * condition;
    result.magnitude = condition * glm::length(dvec3(world_from_group[3])) +
                       frobenius(linear) * std::max(glm::length(target.center), target.magnitude);
    for (Target::Point& p : result.points) p = {point(p.position), glm::normalize(normal_matrix * p.normal)};
    for (dvec3& tip : result.tips) tip = point(tip);
    return result;
}

TestRay random_ray(Random& random, const Target& target) {
    const auto points = static_cast<double>(target.points.size());
    const Target::Point& point = target.points[static_cast<std::size_t>(uniform(random, 0, points))];
    const double far = target.size * std::pow(10.0, uniform(random, -1, 4));
    const double kind = uniform(random, 0, 8);
    dvec3 direction = unit_vector(random);
    dvec3 aim = target.center + 1.2 * target.size * in_ball(random);
    double distance = far;
    bool starts_on_it = false;
    if (kind < 2) {
        // Anywhere near.
    } else if (kind < 3) {
        aim = point.position;
    } else if (kind < 4) {
        direction = glm::normalize(direction - glm::dot(direction, point.normal) * point.normal);
        aim = point.position;
    } else if (kind < 5) {
        distance = 0;
    } else if (kind < 6) {
        direction = axis_parallel(random);
        if (uniform(random, 0, 1) < 0.3) aim = point.position;
    } else {
        aim = point.position;
        distance = 0;
        starts_on_it = true;
    }
    TestRay ray;
    ray.origin = glm::vec3(aim - distance * direction);
    const double length = std::pow(10.0, uniform(random, -3, 3));
    // The origin was rounded: aim anew from where it is now, but keep exact zeros.
    const dvec3 straight = kind >= 5 || distance == 0 ? direction : glm::normalize(aim - dvec3(ray.origin));
    ray.direction = glm::vec3(straight * length);
    if (starts_on_it) {
        ray.exclude = target.id;
        ray.exclude_instance = target.instance;
    }
    return ray;
}

double reach_of(const TestRay& ray, const Target& target) {
    return glm::distance(dvec3(ray.origin), target.center) + target.size;
}

double rounding_of(const TestRay& ray, const Target& target) {
    return 0x1p-24 * (target.condition * reach_of(ray, target) +
                      std::max(glm::length(target.center), target.magnitude));
}

}  // namespace sahl::tests
