// Batches of rays as renders send them and as packets and streams find them hardest.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/device/soups.h"
#include "tests/device/traced_rays.h"

namespace sahl::tests {

struct RaySet {
    std::string name;
    std::vector<TestRay> rays;
};

/// Sets of `count` rays at the soup's targets: of a camera; from one eye through vertices, edges and centres;
/// parallel to an axis; in the planes of targets and along them; from surfaces; into all octants at once; all
/// kinds of rays, one after the other.
std::vector<RaySet> ray_sets(Random& random, const Soup& soup, std::size_t count);

/// Rays that meet nothing: with NaN, infinite components or direction 0.
std::vector<TestRay> bad_rays();

/// A ball around the soup's targets.
struct Surroundings {
    glm::dvec3 center{0};
    double radius = 0;
};
Surroundings surroundings(const Soup& soup);

}  // namespace sahl::tests
