// Primitives of the oracle, in double precision and by other formulas than the kernels': planes
// and inner products, winding numbers, plain quadratics.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::oracle {

/// `direction` may have any length but 0; distances t count in it.
struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction;
};

/// A place where a ray's line meets a surface.
struct Crossing {
    double t = 0;
    glm::dvec3 ng{0};  ///< unit geometric normal in world space: front or outward
    glm::dvec3 ns{0};  ///< unit shading normal in world space, not turned
    glm::dvec2 uv{0};  ///< barycentrics of vertices 1 and 2; 0 for other kinds
};

/// All crossings of a line with one primitive, at any t, and how far it is from having others:
/// `margin` is 0 on an outline or at a rim and grows with the distance in units of the primitive.
struct Crossings {
    Crossing at[2];
    int count = 0;
    double margin = 0;
};

/// A primitive with the matrices between its space and the world.
class Shape {
public:
    Shape(const Scene& scene, const Primitive& primitive);

    /// `starts_here`: the ray starts on this primitive. Planar ones then have no crossing, curved
    /// ones lose the one nearest the origin.
    Crossings cross(const Ray& ray, bool starts_here) const;

    /// False only where the line surely misses.
    bool may_cross(const Ray& ray) const;

private:
    Crossings cross_triangle(const Ray& ray) const;
    Crossings cross_polygon(const Ray& ray) const;
    Crossings cross_sphere(const Ray& ray, bool starts_here) const;
    Crossings cross_cone(const Ray& ray, bool starts_here) const;

    PrimitiveKind kind_;
    bool identity_;
    bool smooth_ = false;
    Sides sides_;
    glm::dmat4 object_from_world_{1};
    glm::dmat3 normal_matrix_{1};      ///< inverse transpose, world from object
    std::vector<glm::dvec3> points_;   ///< corners; sphere: centre; cone: base, apex
    std::vector<glm::dvec3> normals_;  ///< of smooth triangles, unit length in object space
    glm::dvec3 plane_normal_{0};       ///< object space, unit
    double radii_[2] = {0, 0};         ///< sphere: radius; cone: base, apex
    glm::dvec3 bound_center_{0};       ///< of a sphere in world space around the primitive
    double bound_radius_ = 0;
};

}  // namespace sahl::oracle
