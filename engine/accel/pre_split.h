// Cutting long triangles before a tree is built, instead of spatial splits in it: fast, as few triangles are
// long, and each is cut once. Not as good: triangles are cut where they are, not where the tree needs it.
// Source: Karras, Aila 2013, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies",
// sec. 4. Other than theirs: triangles are cut at the middles of their boxes. At the middles of space, where
// that cuts slivers off walls, trees of buildings cost 1.6 times as much.
#pragma once

#include <vector>

#include "engine/accel/bvh.h"
#include "engine/accel/vector_box.h"

namespace sahl {

/// Cuts the long triangles among `references`, whose common box is `box`. There are at most
/// most_references() of their number then, and which these are depends neither on their order nor on the
/// threads. Coordinates must stay below 1e37, as for cut_triangle().
void pre_split(std::vector<BuildPrimitive>& references, const VectorBox& box, const TriangleCorners& corners);

}  // namespace sahl
