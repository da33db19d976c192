// Primitives of the oracle, in double precision and by other formulas than the kernels': planes
// and inner products, winding numbers, plain quadratics, solids face by face.
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
    glm::dvec3 ng{0};           ///< unit geometric normal in world space: front or outward
    glm::dvec3 ns{0};           ///< unit shading normal in world space, not turned
    glm::dvec2 uv{0};           ///< as Scene's kinds of primitives have them
    glm::dvec2 barycentric{0};  ///< of a triangle's vertices 1 and 2
    int part = 0;               ///< face of a box; cone: 0 side, 1 base, 2 top
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
    /// `world_from_space`: from the space that the primitive's own transform leads to.
    Shape(const Scene& scene, const Primitive& primitive, const glm::dmat4& world_from_space = glm::dmat4(1));

    /// `starts_here`: the ray starts on this primitive. Planar ones then have no crossing, curved
    /// ones and solids lose the one nearest the origin.
    Crossings cross(const Ray& ray, bool starts_here) const;

    /// False only where the line surely misses.
    bool may_cross(const Ray& ray) const;

private:
    void find_bound(const glm::dmat4& world_from_object, double reach);
    Crossings cross_in_object_space(const Ray& ray, bool starts_here) const;
    Crossings cross_triangle(const Ray& ray) const;
    Crossings cross_polygon(const Ray& ray) const;
    Crossings cross_disc(const Ray& ray) const;
    Crossings cross_sphere(const Ray& ray, bool starts_here) const;
    Crossings cross_cone(const Ray& ray, bool starts_here) const;
    Crossings cross_solid_cone(const Ray& ray, bool starts_here) const;
    Crossings cross_box(const Ray& ray, bool starts_here) const;

    PrimitiveKind kind_;
    bool identity_;
    bool smooth_ = false;
    bool has_uv_ = false;
    bool solid_ = false;  ///< a cone with caps
    Sides sides_;
    glm::dmat4 object_from_world_{1};
    glm::dmat3 normal_matrix_{1};      ///< inverse transpose, world from object
    std::vector<glm::dvec3> points_;   ///< corners; sphere, disc: centre; cone: base, apex
    std::vector<glm::dvec3> normals_;  ///< of smooth triangles, unit length in object space
    std::vector<glm::dvec2> uvs_;      ///< of triangles with uv
    glm::dvec3 plane_normal_{0};       ///< object space, unit
    double radii_[2] = {0, 0};         ///< sphere, disc: radius; cone: base, apex
    glm::dvec3 bound_center_{0};       ///< of a sphere in world space around the primitive
    double bound_radius_ = 0;
};

/// A primitive of the world or of one instance, in its place.
struct PlacedShape {
    Shape shape;
    std::uint32_t primitive = 0;  ///< index in Scene::primitives
    std::uint32_t instance = 0;   ///< 0: the world's own; else as Aov::instance_id counts
};

/// Everything that rays meet, ordered by (instance, primitive).
std::vector<PlacedShape> place_shapes(const Scene& scene);

/// The matrices to the world from the groups of all instances; [i] is of instance number i + 1.
std::vector<glm::dmat4> instance_placements(const Scene& scene);

}  // namespace sahl::oracle
