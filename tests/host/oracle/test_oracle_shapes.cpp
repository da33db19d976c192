// The oracle's intersections against what can be worked out by hand.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"

namespace sahl::oracle {
namespace {

using glm::dmat4;
using glm::dvec3;

bool equal_points(const dvec3& a, const dvec3& b, double tolerance = 1e-12) {
    return glm::distance(a, b) < tolerance;
}

std::optional<Hit> first_hit(const Scene& scene, const Ray& ray, std::uint32_t start = no_primitive) {
    return Oracle(scene).closest_hit(ray, 0, infinity, {start, 0});
}

TEST_CASE("oracle: a sphere is hit where the ray enters and where it leaves", "[oracle]") {
    Scene scene;
    const std::uint32_t id = add_sphere(scene, {{1, 2, 3}, 2}, {});
    const auto outside = first_hit(scene, {{1, 2, 13}, {0, 0, -2}});
    REQUIRE(outside);
    CHECK(outside->t == Approx(4));
    CHECK(equal_points(outside->ng, {0, 0, 1}));
    CHECK(outside->edge_distance == Approx(1));
    const auto inside = first_hit(scene, {{1, 2, 3}, {0, 1, 0}});
    REQUIRE(inside);
    CHECK(inside->t == Approx(2));
    CHECK(equal_points(inside->ng, {0, 1, 0}));
    // From its own surface: outwards nothing, inwards the far side.
    CHECK_FALSE(first_hit(scene, {{1, 2, 5}, {0, 0, 1}}, id));
    const auto through = first_hit(scene, {{1, 2, 5}, {0, 0, -1}}, id);
    REQUIRE(through);
    CHECK(through->t == Approx(4));
    CHECK_FALSE(first_hit(scene, {{1, 4.001, 13}, {0, 0, -1}}));
    CHECK(Oracle(scene).edge_distance({{1, 4.001, 13}, {0, 0, -1}}) == Approx(0.0005));
}

TEST_CASE("oracle: surfaces seen from inside only let rays in", "[oracle]") {
    Scene scene;
    add_sphere(scene, {{0, 0, 0}, 1}, {});
    scene.primitives.back().sides = Sides::back;
    const auto hit = first_hit(scene, {{0, 0, 5}, {0, 0, -1}});
    REQUIRE(hit);
    CHECK(hit->t == Approx(6));
    Scene pipe;
    add_cone(pipe, {{0, 0, 0}, {0, 0, 2}, 1, 1}, {});
    pipe.primitives.back().sides = Sides::back;
    const auto wall = first_hit(pipe, {{5, 0, 1}, {-1, 0, 0}});
    REQUIRE(wall);
    CHECK(wall->t == Approx(6));
}

TEST_CASE("oracle: triangle barycentrics, winding and interpolated normals", "[oracle]") {
    Scene scene;
    add_triangle(scene, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {}, dmat4(1), {{2, 0, 0}, {0, 0, 3}, {0, 1, 0}});
    const auto hit = first_hit(scene, {{1, 2, 1}, {0, 0, -1}});
    REQUIRE(hit);
    CHECK(hit->uv.x == Approx(0.25));
    CHECK(hit->uv.y == Approx(0.5));
    CHECK(equal_points(hit->ng, {0, 0, 1}));
    CHECK(equal_points(hit->ns, glm::normalize(dvec3(0.25, 0.5, 0.25))));
    CHECK_FALSE(first_hit(scene, {{2.1, 2, 1}, {0, 0, -1}}));
    CHECK_FALSE(first_hit(scene, {{1, 2, 0}, {0, 0, -1}}, 0));
}

TEST_CASE("oracle: a mirrored triangle keeps the front that its object had", "[oracle]") {
    Scene scene;
    add_triangle(scene, {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}, glm::scale(dmat4(1), dvec3(-1, 1, 1)));
    const auto hit = first_hit(scene, {{0, 0, 1}, {0, 0, -1}});
    REQUIRE(hit);
    CHECK(equal_points(hit->ng, {0, 0, 1}));
}

TEST_CASE("oracle: a concave polygon is not hit in its notch", "[oracle]") {
    Scene scene;  // an L
    add_polygon(scene, {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, {});
    const auto hits = [&](double x, double y) {
        return first_hit(scene, {{x, y, 2}, {0, 0, -1}}).has_value();
    };
    CHECK(hits(0.5, 2.5));
    CHECK(hits(2.5, 0.5));
    CHECK_FALSE(hits(2, 2));
    CHECK_FALSE(hits(-0.1, 1));
    CHECK_FALSE(hits(1.5, 3.5));
    CHECK(equal_points(first_hit(scene, {{0.5, 0.5, 2}, {0, 0, -1}})->ng, {0, 0, 1}));
}

TEST_CASE("oracle: cones and cylinders are open", "[oracle]") {
    Scene scene;
    const std::uint32_t id = add_cone(scene, {{0, 0, 0}, {0, 0, 2}, 2, 0}, {});
    const auto hit = first_hit(scene, {{5, 0, 1}, {-1, 0, 0}});
    REQUIRE(hit);
    CHECK(hit->t == Approx(4));
    CHECK(equal_points(hit->ng, glm::normalize(dvec3(1, 0, 1))));
    CHECK_FALSE(first_hit(scene, {{5, 0, 2.1}, {-1, 0, 0}}));
    CHECK_FALSE(first_hit(scene, {{5, 0, -0.1}, {-1, 0, 0}}));
    const auto from_below = first_hit(scene, {{0.5, 0, -1}, {0, 0, 1}});  // in through the missing base
    REQUIRE(from_below);
    CHECK(from_below->t == Approx(2.5));
    const auto across = first_hit(scene, {{1, 0, 1}, {-1, 0, 0}}, id);
    REQUIRE(across);
    CHECK(across->t == Approx(2));
    // Along the slope: the quadratic has one root only.
    const auto along = first_hit(scene, {{-2, 0, 0.5}, {1, 0, -1}});
    REQUIRE(along);
    CHECK(along->t == Approx(0.25));
    Scene pipe;
    add_cone(pipe, {{0, 0, 0}, {0, 3, 0}, 1, 1}, {});
    CHECK_FALSE(first_hit(pipe, {{0.5, -1, 0}, {0, 1, 0}}));
    const auto wall = first_hit(pipe, {{0, 1, 0}, {0, 0, 1}});
    REQUIRE(wall);
    CHECK(equal_points(wall->ng, {0, 0, 1}));
}

TEST_CASE("oracle: of two hits at the same distance the lower id wins", "[oracle]") {
    Scene scene;
    add_square(scene, 0, 1, {});
    add_square(scene, 0, 1, {});
    CHECK(first_hit(scene, {{0.1, 0.2, 1}, {0, 0, -1}})->id.primitive == 0);
}

// Any affine transform: points lie on the surface f = 0 and normals along its gradient.
TEST_CASE("oracle: transformed spheres and cones", "[oracle]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] { return dvec3(uniform(random), uniform(random), uniform(random)); };
    int hits = 0;
    for (int round = 0; round < 400; ++round) {
        dmat4 transform(1);
        for (int column = 0; column < 3; ++column) transform[column] = glm::dvec4(2.0 * vector(), 0);
        transform[3] = glm::dvec4(vector(), 1);
        if (std::abs(glm::determinant(transform)) < 0.1) continue;
        Scene scene;
        if (round % 2 == 0) {
            add_sphere(scene, {{0.1, 0.2, 0.3}, 0.8}, {}, transform);
        } else {
            add_cone(scene, {{0, 0, -1}, {0, 0, 1}, 0.4, 0.9}, {}, transform);
        }
        const dvec3 origin = 5.0 * vector();
        const Ray ray{origin, vector() - origin};
        const auto hit = first_hit(scene, ray);
        if (!hit) continue;
        ++hits;
        CHECK(equal_points(hit->position, ray.origin + hit->t * ray.direction));
        const auto surface = [&](const dvec3& world) {
            const dvec3 p(glm::inverse(transform) * glm::dvec4(world, 1));
            if (round % 2 == 0) return glm::distance(p, dvec3(0.1, 0.2, 0.3)) - 0.8;
            return std::hypot(p.x, p.y) - (0.65 + 0.25 * p.z);
        };
        CHECK(surface(hit->position) == Approx(0).margin(1e-10));
        dvec3 gradient(0);
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 step(0);
            step[axis] = 1e-6;
            gradient[axis] = surface(hit->position + step) - surface(hit->position - step);
        }
        CHECK(equal_points(hit->ng, glm::normalize(gradient), 1e-6));
    }
    CHECK(hits > 50);
}

}  // namespace
}  // namespace sahl::oracle
