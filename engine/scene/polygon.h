// The shape of polygons in a file: their plane, whether a ray can hit them at all, and their
// division into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace sahl {

/// Whether a triangle has no area that float can hold, so that no ray can hit it.
bool is_degenerate(glm::vec3 a, glm::vec3 b, glm::vec3 c);

/// What can be made of a polygon's corners.
enum class PolygonShape {
    planar,
    line,      ///< all corners on one line or point: no area, no ray can hit it
    no_plane,  ///< the corners lie in no plane, or the outline crosses itself so that its area cancels
};

/// At least 3 corners. Planar: no corner is farther from the mean plane (Newell's, through the mean
/// corner) than 1e-3 of the bounding box's diagonal; the six digits of a text file give about 1e-5.
PolygonShape classify_polygon(std::span<const glm::vec3> corners);

/// Twice the polygon's area long; the outline runs counter-clockwise about it.
/// Source: Newell's method, in Sutherland, Sproull, Schumacker 1974, "A Characterization of Ten
/// Hidden-Surface Algorithms".
glm::dvec3 newell_normal(std::span<const glm::vec3> corners);

/// Divides a polygon, convex or concave, into triangles of its corners (indices into `corners`, in
/// the polygon's own sense of rotation) by cutting ears. Corners that lie on an edge or on each other
/// make no triangle without area. None: no ear is left because the outline crosses itself. The same
/// corners give the same triangles. Time O(corners · concave corners).
/// Source: Meisters 1975, "Polygons Have Ears"; Held 2001, "FIST", sec. 2 (ears kept up to date).
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(std::span<const glm::vec3> corners);

}  // namespace sahl
