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

/// Groups of all kinds of primitives, nested, placed by all kinds of affine transforms beside primitives of
/// the world, the first instance twice in one place. Targets are in the order of (instance, id). `unit`: the
/// size that primitives have in some groups, and the inverse of it in others, which instances undo.
/// `flatness`: instances are that many times thinner than wide.
Soup instanced_soup(Random& random, double size, double offset, double unit = 1, double flatness = 1);

/// The same without groups: every instance's primitives in the world by the products of their transforms.
/// `soup`'s targets name the world's primitives in the same order.
Soup without_instances(const Soup& soup);

/// Squares that lie on the faces of cubes and on one another: what they are hit by runs along the boxes of
/// the tree. Each as a polygon, as two triangles or as both.
Soup axis_parallel_soup(Random& random, int count);

std::vector<TestRay> random_rays(Random& random, const Soup& soup, std::size_t count);

}  // namespace sahl::tests
