// Cutting a reference to a triangle in two at a plane: what spatial splits are made of.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/accel/vector_box.h"

namespace sahl {

/// The boxes of what is below and above a plane, both with the plane itself.
struct CutBoxes {
    VectorBox below;
    VectorBox above;
};

/// Cuts the part of a triangle (nine floats) that is in `box` at `plane` along `axis`. Each result lies
/// within `box` and contains its side of that part, rounding included; one that is empty has nothing of it.
/// Coordinates of the corners must stay below 1e37.
CutBoxes cut_triangle(const float* corners, const VectorBox& box, int axis, float plane);

}  // namespace sahl
