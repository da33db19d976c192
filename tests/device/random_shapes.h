// Random primitives of each kind, and rays that test them hard.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/oracle/oracle.h"
#include "engine/scene/scene.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {

enum class ShapeKind {
    triangle,
    polygon,
    sphere,
    ellipsoid,
    cone,
    cylinder,
    disc,
    box,
    solid_cone,
    solid_cylinder
};
constexpr int shape_kind_count = 10;

using Random = std::mt19937_64;

double uniform(Random& random, double lo, double hi);
/// Uniform in the ball of radius 1.
glm::dvec3 in_ball(Random& random);
glm::dvec3 unit_vector(Random& random);
/// Rotated, stretched up to fourfold, sheared, mirrored by chance.
glm::dmat3 random_linear(Random& random);

/// What rays aim at: a primitive's surface and the numbers that its rounding errors grow with.
struct Target {
    struct Point {
        glm::dvec3 position, normal;
    };
    std::uint32_t id = 0;
    std::uint32_t instance = 0;
    bool flat = false;
    glm::dvec3 center{0};
    double size = 1;               ///< a radius around `center`
    double condition = 1;          ///< how unequally its object space is stretched
    double magnitude = 0;          ///< of the coordinates on the way to it, world units
    std::vector<Point> points;     ///< on the surface, on edges, at corners
    std::vector<glm::dvec3> tips;  ///< corners and apexes
};

/// Adds a primitive of about `size` about `center`. `transformed`: by a random affine transform, else by its
/// coordinates (spheres and ellipsoids: by what their kind asks for).
Target add_random_shape(Scene& scene, Random& random, ShapeKind kind, const glm::dvec3& center, double size,
                        bool transformed, const Material& material = {});

/// Where an instance of its group by `world_from_group` has the target.
Target placed(const Target& target, const glm::dmat4& world_from_group, std::uint32_t instance);

/// A ray at the target or just past it, from near, far or within; along edges, at corners, grazing,
/// parallel to axes, starting on the surface; directions of any length.
TestRay random_ray(Random& random, const Target& target);

/// From the ray's origin past the target.
double reach_of(const TestRay& ray, const Target& target);

/// How far single precision may move a ray against `target`, in the world.
double rounding_of(const TestRay& ray, const Target& target);

}  // namespace sahl::tests
