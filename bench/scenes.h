// What is traced and built: procedural scenes, the same on every machine.
#pragma once

#include <span>
#include <string>

#include "engine/scene/scene.h"

namespace sahl::bench {

/// A scene of one camera, at most one light and primitives of one kind, in the world and untransformed, so
/// that an object's index in its array is its id.
struct BenchScene {
    std::string name;
    Scene scene;
};

/// 327,680 triangles of about one size: a sphere with folds.
BenchScene organic_mesh();
/// 1,280,000 triangles: a height field of mountains.
BenchScene terrain_mesh();
/// 10,008,338 triangles: the same, finer.
BenchScene large_terrain_mesh();
/// 330,776 triangles: a hall with columns, stairs, railings and statues, spanned by bars 23.6 long and
/// 0.012 thick.
BenchScene architecture_mesh();

struct SceneMaker {
    const char* name;
    BenchScene (*make)();
};

/// The three meshes.
std::span<const SceneMaker> mesh_makers();

/// Fields of 10,000 and of a million spheres, of open cones and cylinders, and of polygons of 5 to 8 corners,
/// every other one concave: in a cube of edge 10 that is divided into as many cells, one within each.
std::span<const SceneMaker> field_makers();

}  // namespace sahl::bench
