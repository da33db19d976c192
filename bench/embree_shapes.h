// Spheres, cones and polygons for Embree: its own spheres, and a user geometry as its manual describes them,
// single precision and one ray at a time.
#pragma once

#include <memory>

#include "bench/embree_scene.h"

namespace sahl::bench {

/// The scene's spheres as Embree's own; primID is the index in Scene::spheres.
EmbreeGeometry embree_spheres(RTCDevice device, const Scene& scene);

/// The shapes that a user geometry's functions read, which has to end before them.
struct UserShapes;
struct UserShapesDelete {
    void operator()(UserShapes* shapes) const;
};
using OwnedUserShapes = std::unique_ptr<UserShapes, UserShapesDelete>;

/// From a scene of spheres, open cones or polygons alone.
OwnedUserShapes user_shapes(const Scene& scene);

/// A user geometry of them; primID is the index in Scene::primitives.
EmbreeGeometry embree_user_geometry(RTCDevice device, UserShapes& shapes);

}  // namespace sahl::bench
