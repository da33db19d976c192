#include "engine/scene/validate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace sahl {

void check_range(double value, Range range, std::string_view what, const SourceLocation& where) {
    if (range.contains(value)) return;
    if (range.low == -range.high) {
        throw SceneError(where, fmt::format("{} must lie within ±{:g}, not {:g}", what, range.high, value));
    }
    throw SceneError(where, fmt::format("{} must be {} {:g} and {} {:g}, not {:g}", what,
                                        range.inclusive ? "at least" : "greater than", range.low,
                                        range.inclusive ? "at most" : "less than", range.high, value));
}

void check_camera(const Camera& camera, const SourceLocation& look_at, const SourceLocation& up) {
    const double distance = glm::length(camera.look_at - camera.eye);
    if (distance < min_length) {
        throw SceneError(look_at,
                         "the camera looks at the point it stands on; give it another point to look at");
    }
    const double up_length = glm::length(camera.up);
    if (up_length < min_length) {
        throw SceneError(up, "the camera's up vector is zero; give it a direction, such as 0 1 0");
    }
    const glm::dvec3 forward = (camera.look_at - camera.eye) / distance;
    if (glm::length(glm::cross(camera.up / up_length, forward)) < 1e-9) {
        throw SceneError(
            up, "the camera's up vector is parallel to the viewing direction; give it another direction");
    }
}

namespace {

double frobenius_norm(const glm::dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

}  // namespace

bool is_invertible(const glm::dmat4& m) {
    // The condition number bounds the ratio of the axes.
    const glm::dmat3 linear(m);
    if (glm::determinant(linear) == 0) return false;
    return frobenius_norm(linear) * frobenius_norm(glm::inverse(linear)) < 1e12;
}

void check_sphere_transform(const glm::dmat4& m, glm::dvec3 center, double radius,
                            const SourceLocation& where) {
    if (!is_invertible(m)) {
        throw SceneError(
            where, "the transformation flattens this sphere (it has no inverse); use no scale factor of 0");
    }
    const glm::dmat3 linear(m);
    if (radius / frobenius_norm(glm::inverse(linear)) < min_length) {
        throw SceneError(where, fmt::format("the transformation shrinks this sphere below {:g}", min_length));
    }
    const glm::dvec3 world = glm::dvec3(m * glm::dvec4(center, 1));
    const double reach =
        std::max({std::abs(world.x), std::abs(world.y), std::abs(world.z)}) + radius * frobenius_norm(linear);
    if (!(reach <= max_magnitude)) {
        throw SceneError(where,
                         fmt::format("the transformation takes this sphere beyond ±{:g}", max_magnitude));
    }
}

}  // namespace sahl
