// Sets of primitives to build trees over: seeded, the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/accel/bvh.h"

namespace sahl::test {

/// How a set is spread in space. The last ones are degenerate or made to provoke deep trees.
enum class Spread {
    uniform,
    clustered,
    plane,           // z = 0, so no box has a volume
    line,            // points on a line: no box has an area
    point,           // all boxes are one point
    same_box,        // all boxes are one cube
    concentric,      // different cubes, one centre
    grid,            // many equal centroids along each axis
    series,          // cubes that shrink towards the origin along x, then y, then z
    growing,         // cubes [0, 1.25^i]³
    far,             // 1e15 from the origin
    tiny,            // extents of denormals
    negative_zeros,  // -0 and +0 mixed
};

inline constexpr Spread all_spreads[] = {
    Spread::uniform,  Spread::clustered,  Spread::plane,          Spread::line,   Spread::point,
    Spread::same_box, Spread::concentric, Spread::grid,           Spread::series, Spread::growing,
    Spread::far,      Spread::tiny,       Spread::negative_zeros,
};

/// [0, 1), the same on every standard library.
float uniform(std::mt19937& random);

Bounds cube(float x, float y, float z, float size);

/// `size` primitives, ids a permutation of 0..size-1 in random order; kinds all triangles or random.
std::vector<BuildPrimitive> make_primitives(Spread spread, std::size_t size, bool mixed, std::uint32_t seed);

}  // namespace sahl::test
