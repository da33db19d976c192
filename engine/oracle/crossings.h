// What the crossings of several kinds of primitives share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/oracle/shape.h"

namespace sahl::oracle {

using Candidates = std::vector<Crossing>;

/// The angle of `vector` about unit `axis`, 0..1 of a turn, from where cross(x, axis) points, or
/// cross(y, axis) if the axis lies along x.
inline double turn_about(const glm::dvec3& axis, const glm::dvec3& vector) {
    const glm::dvec3 helper = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, axis));
    const double angle = std::atan2(glm::dot(vector, glm::cross(axis, x)), glm::dot(vector, x));
    return angle / (2 * std::numbers::pi) + (angle < 0 ? 1 : 0);
}

/// A line meets a convex solid in one chord, whatever rounding says of the rims on its surface:
/// its ends. `starts_here`: less the one nearest the ray's origin.
inline Crossings solid_crossings(const Candidates& candidates, double margin, bool starts_here) {
    Crossings result;
    result.margin = margin;
    if (candidates.empty()) return result;
    const auto by_t = [](const Crossing& a, const Crossing& b) { return a.t < b.t; };
    const auto [enter, leave] = std::minmax_element(candidates.begin(), candidates.end(), by_t);
    const bool enter_is_start = std::abs(enter->t) <= std::abs(leave->t);
    if (!(starts_here && enter_is_start)) result.at[result.count++] = *enter;
    if (enter == leave) {
        if (starts_here) result.count = 0;
        return result;
    }
    if (!(starts_here && !enter_is_start)) result.at[result.count++] = *leave;
    return result;
}

}  // namespace sahl::oracle
