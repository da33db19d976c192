#include "engine/scene/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

namespace sahl {

std::string number_text(double x) {
    const bool whole = std::floor(x) == x && std::abs(x) < max_magnitude;
    return whole ? fmt::format("{:.0f}", x) : fmt::format("{:g}", x);
}

void check_range(double value, Range range, std::string_view what, const SourceLocation& where) {
    if (range.contains(value)) return;
    if (range.low == -range.high) {
        throw SceneError(where, fmt::format("{} must lie within ±{}, not {}", what, number_text(range.high),
                                            number_text(value)));
    }
    throw SceneError(where, fmt::format("{} must be {} {} and {} {}, not {}", what,
                                        range.inclusive ? "at least" : "greater than", number_text(range.low),
                                        range.inclusive ? "at most" : "less than", number_text(range.high),
                                        number_text(value)));
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

// Whether a transformed length is less than min_length, by more than rounding. The norm takes the shortest
// axis for up to √3 of itself, and is exact where all are alike.
bool shrinks_too_much(double length, const glm::dmat3& m) {
    const double scale = std::sqrt(3.0) / frobenius_norm(glm::inverse(m));
    return length * scale < min_length * (1 - 1e-9);
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
    if (shrinks_too_much(radius, linear)) {
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

void check_transform(const glm::dmat4& m, const SourceLocation& where, std::string_view advice) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            check_range(m[column][row], any_number, "every element of the transformation", where);
        }
    }
    if (!is_invertible(m)) {
        throw SceneError(where, fmt::format("this transformation flattens what it is applied to (it has no "
                                            "inverse); {}",
                                            advice));
    }
}

void Extent::add(glm::dvec3 point) {
    lo = glm::min(lo, point);
    hi = glm::max(hi, point);
}

void Extent::add(const Extent& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
}

Extent Extent::transformed(const glm::dmat4& m) const {
    Extent result;
    if (empty()) return result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point((corner & 1) != 0 ? hi.x : lo.x, (corner & 2) != 0 ? hi.y : lo.y,
                               (corner & 4) != 0 ? hi.z : lo.z);
        result.add(glm::dvec3(m * glm::dvec4(point, 1)));
    }
    return result;
}

bool Extent::within(double magnitude) const {
    return empty() || (glm::all(glm::greaterThanEqual(lo, glm::dvec3(-magnitude))) &&
                       glm::all(glm::lessThanEqual(hi, glm::dvec3(magnitude))));
}

Extent extent_of(const Scene& scene, const Primitive& primitive) {
    Extent extent;
    const auto add_ball = [&](glm::dvec3 center, double radius) {
        extent.add(center - radius);
        extent.add(center + radius);
    };
    switch (primitive.kind) {
        case PrimitiveKind::triangle:
            for (const std::uint32_t i : scene.triangles[primitive.index].vertices) {
                extent.add(scene.vertices[i]);
            }
            break;
        case PrimitiveKind::polygon: {
            const Polygon& polygon = scene.polygons[primitive.index];
            for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
                extent.add(scene.polygon_vertices[polygon.first_vertex + i]);
            }
            break;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene.spheres[primitive.index];
            add_ball(sphere.center, sphere.radius);
            break;
        }
        case PrimitiveKind::cone: {
            const Cone& cone = scene.cones[primitive.index];
            add_ball(cone.base, cone.base_radius);
            add_ball(cone.apex, cone.apex_radius);
            break;
        }
        case PrimitiveKind::disc: {
            const Disc& disc = scene.discs[primitive.index];
            add_ball(disc.center, disc.radius);
            break;
        }
        case PrimitiveKind::box:
            extent.add(scene.boxes[primitive.index].lo);
            extent.add(scene.boxes[primitive.index].hi);
            break;
    }
    return extent;
}

namespace {

// The shortest length that an analytic primitive is computed with, 0 where there is none.
double least_length(const Scene& scene, const Primitive& primitive) {
    switch (primitive.kind) {
        case PrimitiveKind::sphere:
            return scene.spheres[primitive.index].radius;
        case PrimitiveKind::cone: {
            const Cone& cone = scene.cones[primitive.index];
            const double height = glm::length(cone.apex - cone.base);
            const double wide = std::max(cone.base_radius, cone.apex_radius);
            const double narrow = std::min(cone.base_radius, cone.apex_radius);
            return std::min(height, narrow > 0 ? narrow : wide);
        }
        case PrimitiveKind::disc:
            return scene.discs[primitive.index].radius;
        case PrimitiveKind::box: {
            const glm::dvec3 size = scene.boxes[primitive.index].hi - scene.boxes[primitive.index].lo;
            return std::min({size.x, size.y, size.z});
        }
        case PrimitiveKind::triangle:
        case PrimitiveKind::polygon:
            break;
    }
    return 0;
}

}  // namespace

void check_placed(const Scene& scene, const Primitive& primitive, const glm::dmat4& m,
                  const SourceLocation& where) {
    constexpr std::array<std::string_view, 6> names = {"triangle", "polygon", "sphere",
                                                       "cone",     "disc",    "box"};
    const std::string_view name = names[static_cast<std::size_t>(primitive.kind)];
    const double length = least_length(scene, primitive);
    if (length > 0 && shrinks_too_much(length, glm::dmat3(m))) {
        throw SceneError(where,
                         fmt::format("the transformation shrinks this {} below {:g}", name, min_length));
    }
    const Extent extent = extent_of(scene, primitive).transformed(m);
    if (!extent.within(max_magnitude)) {
        throw SceneError(where, fmt::format("this {} reaches beyond ±{:g}, where its transformation takes it",
                                            name, max_magnitude));
    }
    for (int axis = 0; axis < 3 && length > 0; ++axis) {
        if (static_cast<float>(extent.lo[axis]) != static_cast<float>(extent.hi[axis])) continue;
        throw SceneError(where, fmt::format("this {} is too thin for its place: along {} it begins and ends "
                                            "at the same number of single precision, {:g}; make it larger "
                                            "or move it nearer to the origin",
                                            name, "xyz"[axis], extent.lo[axis]));
    }
}

}  // namespace sahl
