// Shapes made of triangles.
#pragma once

#include <functional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::bench {

/// A scene without primitives, seen by a camera and lit from `light`.
Scene empty_scene(glm::dvec3 eye, glm::dvec3 look_at, double fov_y, glm::dvec3 light);

/// Appends an object to the scene's primitives: number `index` of the array of its kind.
void add_primitive(Scene& scene, PrimitiveKind kind, std::size_t index);

void add_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// columns × rows quads, halved; `position` is asked for the corners (0..columns, 0..rows).
void add_grid(Scene& scene, int columns, int rows, const std::function<glm::vec3(int, int)>& position);

/// The parallelepiped about `center` with half edges x, y, z: 12 triangles.
void add_block(Scene& scene, glm::vec3 center, glm::vec3 x, glm::vec3 y, glm::vec3 z);

/// A straight bar of square cross-section, `thickness` wide.
void add_bar(Scene& scene, glm::vec3 from, glm::vec3 to, float thickness);

/// The profile, points (radius, height), turned about the vertical axis through `foot`.
void add_lathe(Scene& scene, glm::vec3 foot, std::span<const glm::vec2> profile, int segments);

/// 20 · 4^levels triangles of an icosahedron subdivided and projected onto the unit sphere, then moved to
/// where `place` puts the direction.
void add_icosphere(Scene& scene, int levels, const std::function<glm::vec3(glm::vec3)>& place);

}  // namespace sahl::bench
