// What no scene may hold, whatever its format: the loaders call these at the place of the value.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/core/error.h"
#include "engine/scene/scene.h"

namespace sahl {

/// Numbers of a scene (coordinates, colours, matrix elements) are at most this large: float's range
/// leaves room for their squares.
constexpr double max_magnitude = 1e15;

/// Lengths that must not vanish (radii, distances) are at least this: their squares and inverses are
/// normal floats.
constexpr double min_length = 1e-15;

/// The most instances that a scene places, those inside placed groups included, and the most groups
/// inside each other: what the renderer numbers and walks.
constexpr std::uint64_t max_placed = 0x07ffffff;
constexpr int max_group_nesting = 64;

/// Largest width and height of an image in pixels.
constexpr int max_resolution = 65536;

/// Allowed values of a number.
struct Range {
    double low = -max_magnitude;
    double high = max_magnitude;
    bool inclusive = true;  ///< whether the ends themselves are allowed

    constexpr bool contains(double x) const {
        return inclusive ? x >= low && x <= high : x > low && x < high;
    }
};

constexpr Range any_number{};
constexpr Range not_negative{0, max_magnitude};
constexpr Range positive_length{min_length, max_magnitude};
constexpr Range field_of_view{0, 180, false};  ///< degrees

/// A number for a message: whole ones with all their digits, others with six.
std::string number_text(double x);

/// Throws SceneError "`what` must be …" unless `value` is finite and in `range`.
void check_range(double value, Range range, std::string_view what, const SourceLocation& where);

/// Throws SceneError, at `look_at` or `up`, unless the eye differs from look_at and up is no
/// multiple of the viewing direction.
void check_camera(const Camera& camera, const SourceLocation& look_at, const SourceLocation& up);

/// Whether an affine transformation has an inverse that double holds with a few digits: its longest
/// axis is less than 1e12 of its shortest.
bool is_invertible(const glm::dmat4& m);

/// Throws SceneError unless `m` (affine, applied to a sphere of `radius` about `center`) can be
/// inverted and leaves an ellipsoid inside ±max_magnitude.
void check_sphere_transform(const glm::dmat4& m, glm::dvec3 center, double radius,
                            const SourceLocation& where);

/// Throws SceneError unless `m` is affine, can be inverted and has no element beyond ±max_magnitude.
/// `advice` says what to do about one without an inverse.
void check_transform(const glm::dmat4& m, const SourceLocation& where,
                     std::string_view advice =
                         "use no scale factor of 0, and none that is less than 1e-12 "
                         "of another");

/// An axis-aligned box; empty while lo > hi.
struct Extent {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()};
    glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

    bool empty() const { return lo.x > hi.x; }
    void add(glm::dvec3 point);
    void add(const Extent& other);
    /// Around the transformed box.
    Extent transformed(const glm::dmat4& m) const;
    bool within(double magnitude) const;
};

/// A box around a primitive, in its object space.
Extent extent_of(const Scene& scene, const Primitive& primitive);

/// Throws SceneError unless `m`, whose inverse exists, leaves the primitive (its own transform does
/// not count) inside ±max_magnitude, a solid no smaller than min_length, and in single
/// precision no less than a unit in the last place thick along each axis.
void check_placed(const Scene& scene, const Primitive& primitive, const glm::dmat4& m,
                  const SourceLocation& where);

}  // namespace sahl
