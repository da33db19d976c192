// Sets of triangles to build trees over: seeded, the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/accel/bvh.h"

namespace sahl::test {

/// How a set's triangles lie.
enum class Triangles {
    small,      // in a cube, much smaller than it
    crossed,    // thin and as long as the cube, in all directions
    beams,      // one in ten crosses, the others are small
    giant,      // one across the cube among small ones
    slivers,    // long ones whose corners are (nearly) on a line
    identical,  // long, all the same
    lines,      // without area: two corners coincide
    points,     // all three do
    far,        // 1e15 from the origin, as large
    flat,       // large ones in the plane z = 0
};

inline constexpr Triangles all_triangles[] = {
    Triangles::small,     Triangles::crossed, Triangles::beams,  Triangles::giant, Triangles::slivers,
    Triangles::identical, Triangles::lines,   Triangles::points, Triangles::far,   Triangles::flat,
};

struct TriangleSet {
    std::vector<float> data;  ///< nine floats a triangle, by id
    std::vector<device::DevicePrimitive> lowered;
    std::vector<BuildPrimitive> primitives;

    TriangleCorners corners() const { return {data.data(), lowered.data()}; }
};

TriangleSet make_triangles(Triangles kind, std::size_t size, std::uint32_t seed);

}  // namespace sahl::test
