#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "engine/render/lower_scene.h"
#include "engine/render/two_floats.h"

namespace sahl::tests {

namespace {

double number_at(const LoweredScene& lowered, std::uint32_t at) {
    return double{lowered.shape_data[at]} + double{lowered.shape_data[at + 1]};
}

glm::dvec3 vector_at(const LoweredScene& lowered, std::uint32_t at) {
    const float* data = &lowered.shape_data[at];
    return {double{data[0]} + double{data[3]}, double{data[1]} + double{data[4]},
            double{data[2]} + double{data[5]}};
}

void check_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
    CAPTURE(value.x, value.y, value.z, expected.x, expected.y, expected.z);
    CHECK(glm::length(value - expected) <= tolerance);
}

/// A scene of one sphere, cone, square and smooth triangle under `world_from_object`.
Scene one_of_each(const glm::dmat4& world_from_object) {
    Scene scene;
    scene.materials.emplace_back();
    scene.transforms.push_back(world_from_object);
    scene.spheres.push_back({{0.4293, 0.115031, 0.544331}, 0.0555556});
    scene.cones.push_back({{0.1, 0.2, 0.3}, {0.1, 0.2, 1.7}, 0.3, 0.7});
    scene.polygon_vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.polygons.push_back({0, 4});
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.normals = {{0, 0, 1}, {0, 3, 4}, {0, 0, 2}};
    scene.triangles.push_back({{0, 1, 2}, {0, 1, 2}, true});
    scene.primitives = {{PrimitiveKind::sphere, 0, 0, 1},
                        {PrimitiveKind::cone, 0, 0, 1},
                        {PrimitiveKind::polygon, 0, 0, 1},
                        {PrimitiveKind::triangle, 0, 0, 1}};
    return scene;
}

}  // namespace

TEST_CASE("two floats hold a double to 48 bits") {
    for (const double value : {0.4293, -0.115031, 0.544331, 1e-20, -123456.789, 1.0 / 3, 0.0}) {
        const TwoFloats parts = split(value);
        CHECK(parts.high == static_cast<float>(value));
        CHECK(std::abs(double{parts.high} + double{parts.low} - value) <= std::ldexp(std::abs(value), -48));
    }
}

TEST_CASE("lowered shapes keep the precision of the scene") {
    const LoweredScene lowered = lower_scene(one_of_each(glm::dmat4(1)));
    REQUIRE(lowered.primitives.size() == 4);

    const device::DevicePrimitive& sphere = lowered.primitives[0];
    CHECK(sphere.kind == SAHL_KIND_SPHERE);
    check_near(vector_at(lowered, sphere.data), {0.4293, 0.115031, 0.544331}, 1e-14);
    CHECK(number_at(lowered, sphere.data + 6) == Approx(0.0555556).epsilon(1e-14));

    // The wider end is the object's origin: here the apex; along the axis m brings z from 0 to 1.
    const device::DevicePrimitive& cone = lowered.primitives[1];
    CHECK(cone.kind == SAHL_KIND_CONE);
    check_near(vector_at(lowered, cone.data + 18), {0.1, 0.2, 1.7}, 1e-14);
    check_near(vector_at(lowered, cone.data + 12), {0, 0, -1 / 1.4}, 1e-14);
    CHECK(number_at(lowered, cone.data + 24) == Approx((0.3 - 0.7) / 0.7).epsilon(1e-14));

    const device::DevicePrimitive& square = lowered.primitives[2];
    CHECK(square.kind == SAHL_KIND_POLYGON);
    check_near(vector_at(lowered, square.data), {0, 0, 1}, 1e-14);
}

TEST_CASE(
    "an outline's groups begin with the corner that the last one ends with, and end with the first corner") {
    Scene scene;
    for (const std::uint32_t corners : {3U, 7U, 8U, 20U}) {
        scene.primitives.push_back(
            {PrimitiveKind::polygon, static_cast<std::uint32_t>(scene.polygons.size()), 0});
        scene.polygons.push_back({static_cast<std::uint32_t>(scene.polygon_vertices.size()), corners});
        for (std::uint32_t i = 0; i < corners; ++i) {
            const double angle = 6.283185307179586 * i / corners;
            scene.polygon_vertices.emplace_back(std::cos(angle), std::sin(angle), corners);
        }
    }
    scene.materials.resize(1);
    const LoweredScene lowered = lower_scene(scene);
    REQUIRE(lowered.outlines.size() == 24 * (1 + 1 + 2 + 3));
    CHECK(lowered.outlines.size() == outline_floats(scene));
    std::size_t group = 0;
    for (const Polygon& polygon : scene.polygons) {
        for (std::uint32_t first = 0; first < polygon.vertex_count; first += 7, ++group) {
            for (std::uint32_t lane = 0; lane < 8; ++lane) {
                const std::uint32_t corner = first + lane < polygon.vertex_count ? first + lane : 0;
                const glm::vec3 wanted = scene.polygon_vertices[polygon.first_vertex + corner];
                const float* lanes = &lowered.outlines[24 * group + lane];
                CHECK(glm::vec3(lanes[0], lanes[8], lanes[16]) == wanted);
            }
        }
    }
}

TEST_CASE("normals stay outward under a mirroring transform") {
    const LoweredScene lowered = lower_scene(one_of_each(glm::scale(glm::dmat4(1), {1.0, 1.0, -2.0})));
    // The square and the triangle face +z in their own space, so -z in the mirrored world.
    check_near(vector_at(lowered, lowered.primitives[2].data), {0, 0, -1}, 1e-14);
    const float* data = &lowered.shape_data[lowered.primitives[3].data];
    const glm::vec3 v0(data[0], data[1], data[2]), v1(data[3], data[4], data[5]),
        v2(data[6], data[7], data[8]);
    CHECK(glm::cross(v1 - v0, v2 - v0).z < 0);
    CHECK(lowered.primitives[3].flags == SAHL_PRIMITIVE_SMOOTH);
    // Corners 1 and 2 change places with their normals: (0, .6, .8) goes by the inverse transpose.
    check_near({data[15], data[16], data[17]}, {0, 0.6, -0.4}, 1e-6);
}

TEST_CASE("spheres stay spheres under similarities alone") {
    Scene scene = one_of_each(glm::rotate(glm::scale(glm::dmat4(1), glm::dvec3(3)), 0.7, {1.0, 2.0, 3.0}));
    CHECK(lower_scene(scene).primitives[0].kind == SAHL_KIND_SPHERE);
    scene.transforms[1] = glm::scale(glm::dmat4(1), {1.0, 1.0, 1.001});
    CHECK(lower_scene(scene).primitives[0].kind == SAHL_KIND_ELLIPSOID);
}

TEST_CASE("bounds contain the shapes") {
    const glm::dmat4 shear(1, 0.5, 0, 0, 0, 1, 0.25, 0, 0.1, 0, 1, 0, 5, -6, 7, 1);
    const LoweredScene lowered = lower_scene(one_of_each(shear));
    const auto contains = [&](std::size_t primitive, const glm::dvec3& object_point) {
        const glm::dvec3 p(shear * glm::dvec4(object_point, 1));
        const Bounds& bounds = lowered.build_primitives[primitive].bounds;
        for (int k = 0; k < 3; ++k) {
            if (p[k] < bounds.lo[k] || p[k] > bounds.hi[k]) return false;
        }
        return true;
    };
    for (int i = 0; i < 1000; ++i) {
        const double a = 0.01 * i, z = std::cos(0.37 * i), r = std::sqrt(1 - z * z);
        CHECK(contains(0, glm::dvec3(0.4293, 0.115031, 0.544331) +
                              0.0555556 * glm::dvec3(r * std::cos(a), r * std::sin(a), z)));
        CHECK(contains(1, {0.1 + 0.3 * std::cos(a), 0.2 + 0.3 * std::sin(a), 0.3}));
        CHECK(contains(1, {0.1 + 0.7 * std::cos(a), 0.2 + 0.7 * std::sin(a), 1.7}));
    }
}

TEST_CASE("discs, boxes and closed cones become unit shapes of their own spaces") {
    const glm::dmat4 shear(1, 0.5, 0, 0, 0, 1, 0.25, 0, 0.1, 0, -1, 0, 5, -6, 7, 1);
    Scene scene = one_of_each(shear);
    scene.discs.push_back({{0.1, 0.2, 0.3}, {1, 2, 2}, 0.5});
    scene.boxes.push_back({{-1, 2, 3}, {2, 4, 10}});
    scene.cones[0].capped = true;
    scene.primitives = {{PrimitiveKind::disc, 0, 0, 1},
                        {PrimitiveKind::box, 0, 0, 1},
                        {PrimitiveKind::cone, 0, 0, 1, Sides::front}};
    const LoweredScene lowered = lower_scene(scene);
    CHECK(lowered.primitives[0].kind == SAHL_KIND_DISC);
    CHECK(lowered.primitives[1].kind == SAHL_KIND_BOX);
    CHECK(lowered.primitives[2].kind == SAHL_KIND_SOLID_CONE);
    CHECK((block_id(scene, 2) & SAHL_ID_FRONT_ONLY) != 0);
    CHECK((block_id(scene, 1) & (SAHL_ID_FRONT_ONLY | SAHL_ID_BACK_ONLY)) == 0);
    const auto in_own_space = [&](std::size_t primitive, const glm::dvec3& object_point) {
        const std::uint32_t data = lowered.primitives[primitive].data;
        const glm::dvec3 p = glm::dvec3(shear * glm::dvec4(object_point, 1)) - vector_at(lowered, data + 18);
        return glm::dvec3(glm::dot(vector_at(lowered, data), p), glm::dot(vector_at(lowered, data + 6), p),
                          glm::dot(vector_at(lowered, data + 12), p));
    };
    check_near(in_own_space(0, {0.1, 0.2, 0.3}), {0, 0, 0}, 1e-12);
    const glm::dvec3 rim =
        in_own_space(0, glm::dvec3(0.1, 0.2, 0.3) + 0.5 * glm::normalize(glm::dvec3(2, -1, 0)));
    CHECK(rim.z == Approx(0).margin(1e-12));
    CHECK(std::hypot(rim.x, rim.y) == Approx(1));
    CHECK(in_own_space(0, {1.1, 2.2, 2.3}).z > 0);
    check_near(in_own_space(1, {-1, 2, 3}), {-1, -1, -1}, 1e-12);
    check_near(in_own_space(1, {2, 4, 10}), {1, 1, 1}, 1e-12);
    const Bounds& bounds = lowered.build_primitives[1].bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(shear *
                           glm::dvec4(corner & 1 ? 2 : -1, corner & 2 ? 4 : 2, corner & 4 ? 10 : 3, 1));
        for (int k = 0; k < 3; ++k) {
            CHECK(double{bounds.lo[k]} <= p[k]);
            CHECK(double{bounds.hi[k]} >= p[k]);
        }
    }
}

TEST_CASE("a primitive without a finite place is refused") {
    Scene scene = one_of_each(glm::dmat4(1));
    scene.transforms[1][3][0] = std::numeric_limits<double>::infinity();
    try {
        lower_scene(scene);
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        CHECK(std::string(error.what()).find("primitive 0") != std::string::npos);
    }
}

}  // namespace sahl::tests
