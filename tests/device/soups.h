// Many primitives at once, and rays at them.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/scene/scene.h"
#include "tests/device/random_shapes.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {

struct Soup {
    Scene scene;
    std::vector<Target> targets;
};

/// Primitives of all kinds crowded together about a point at distance `offset`, every eighth of them twice.
Soup random_soup(Random& random, int count, double size, double offset);

/// Squares that lie on the faces of cubes and on one another: what they are hit by runs along the boxes of
/// the tree. Each as a polygon, as two triangles or as both.
Soup axis_parallel_soup(Random& random, int count);

std::vector<TestRay> random_rays(Random& random, const Soup& soup, std::size_t count);

}  // namespace sahl::tests
