// Closed surfaces around the origin of their own, made of faces that share vertices exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/scene/scene.h"
#include "tests/device/random_shapes.h"

namespace sahl::tests {

/// Faces of three corners are triangles, others polygons. All corners are floats.
struct ClosedMesh {
    glm::vec3 center{0};  ///< from here every direction meets a face, and from `core` around it
    float core = 0;
    std::vector<glm::vec3> vertices;
    std::vector<std::vector<std::uint32_t>> faces;

    Scene scene() const;
};

/// A subdivided icosahedron. `roughness`: how much of the radius its vertices move in and out; 0 is convex.
ClosedMesh icosphere(Random& random, int subdivisions, double radius, double roughness,
                     const glm::dvec3& center);

/// The same with its vertices rounded to a grid so coarse that faces shrink to needles, lines and points.
ClosedMesh crumpled(ClosedMesh mesh, float grid);

/// A cube of `half` half side under a random rotation whose faces are each cut along a zigzag from corner to
/// corner into two concave polygons, or into quadrangles.
ClosedMesh zigzag_cube(Random& random, double half, const glm::dvec3& center);
ClosedMesh quadrangle_cube(Random& random, int cuts, double half, const glm::dvec3& center);

/// Rays that have to hit the mesh: from its core at vertices, at points of edges and at random, or from far
/// outside through its core. Packet by packet they go any way, or all start at one point and those at
/// vertices and edges go to neighbouring faces.
std::vector<TestRay> rays_at(Random& random, const ClosedMesh& mesh, std::size_t count);

}  // namespace sahl::tests
