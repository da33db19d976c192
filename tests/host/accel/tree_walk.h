// Walks a tree as traversal would and finds out all that the builder promises about it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/accel/bvh.h"
#include "tests/host/accel/triangles.h"

namespace sahl::test {

struct TreeFacts {
    std::string fault;           ///< the first broken promise, empty if there is none
    int depth = 0;               ///< levels of nodes
    std::size_t stack_need = 0;  ///< most entries a traversal stack can hold
    double sah_cost = 0;         ///< as BvhStatistics defines it
};

/// `fault` tells of primitives missing or doubled, boxes that are not exactly the box of what is
/// below, wrong order of nodes or leaves, wrong references, leaves too large or of several kinds.
TreeFacts walk(const Bvh& bvh, const std::vector<BuildPrimitive>& primitives);

/// The same of a tree in which triangles may be cut: leaves' boxes lie within those of what they hold, each
/// point of a grid on each triangle is in the box of a leaf that has it, and all other primitives are in one
/// leaf, which contains them.
TreeFacts walk_parts(const Bvh& bvh, const TriangleSet& set);

}  // namespace sahl::test
