#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/scene/polygon.h"

namespace sahl::tests {
namespace {

using Corners = std::vector<glm::vec3>;

double area_of(const Corners& corners, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    double area = 0;
    for (const auto& [a, b, c] : triangles) {
        const Corners triangle = {corners[a], corners[b], corners[c]};
        area += glm::length(newell_normal(triangle)) / 2;
    }
    return area;
}

// A star of `points` points in the plane through `center` spanned by u and v: every second corner is concave.
Corners star(int points, glm::dvec3 u, glm::dvec3 v, glm::dvec3 center) {
    Corners corners;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = 3.14159265358979 * i / points;
        const double radius = i % 2 == 0 ? 1.0 : 0.3;
        corners.emplace_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return corners;
}

}  // namespace

TEST_CASE("Newell's normal is twice the area and sees the outline counter-clockwise", "[scene]") {
    const Corners square = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    CHECK(newell_normal(square) == glm::dvec3(0, 0, 8));
    // An L, whose third corner is concave.
    const Corners l = {{0, 0, 5}, {2, 0, 5}, {2, 1, 5}, {1, 1, 5}, {1, 2, 5}, {0, 2, 5}};
    CHECK(newell_normal(l) == glm::dvec3(0, 0, 6));
}

TEST_CASE("Shapes of polygons", "[scene]") {
    const auto shape = [](const Corners& corners) { return classify_polygon(corners); };
    CHECK(shape({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}) == PolygonShape::planar);
    CHECK(shape({{0, 0, 0}, {2, 0, 0}, {2, 2, 0.002F}, {0, 2, 0}}) == PolygonShape::planar);
    CHECK(shape({{0, 0, 0}, {2, 0, 0}, {2, 2, 0.1F}, {0, 2, 0}}) == PolygonShape::no_plane);
    CHECK(shape({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}) == PolygonShape::line);
    CHECK(shape({{4, 5, 6}, {4, 5, 6}, {4, 5, 6}, {4, 5, 6}}) == PolygonShape::line);
    CHECK(shape({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {0, 2, 0}}) == PolygonShape::planar);
    // A bow tie of two equal wings.
    CHECK(shape({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}) == PolygonShape::no_plane);
    // The tolerance goes with the size.
    for (const float s : {1e-6F, 1e6F}) {
        CHECK(shape({{0, 0, 0}, {2 * s, 0, 0}, {2 * s, 2 * s, 0.002F * s}, {0, 2 * s, 0}}) ==
              PolygonShape::planar);
        CHECK(shape({{0, 0, 0}, {2 * s, 0, 0}, {2 * s, 2 * s, 0.1F * s}, {0, 2 * s, 0}}) ==
              PolygonShape::no_plane);
    }
    // A long thin bar, far away.
    CHECK(shape({{1e4F, 0, 0}, {1e4F + 100, 0, 0}, {1e4F + 100, 0.01F, 0}, {1e4F, 0.01F, 0}}) ==
          PolygonShape::planar);
}

TEST_CASE("Triangles without area", "[scene]") {
    CHECK_FALSE(is_degenerate({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    CHECK_FALSE(is_degenerate({0, 0, 0}, {1, 0, 0}, {0, 1e-20F, 0}));
    CHECK(is_degenerate({1, 2, 3}, {1, 2, 3}, {0, 1, 0}));
    CHECK(is_degenerate({0, 0, 0}, {0.1F, 0.1F, 0.1F}, {0.3F, 0.3F, 0.3F}));
    CHECK(is_degenerate({0, 0, 0}, {1e-20F, 0, 0}, {0, 1e-20F, 0}));
}

TEST_CASE("A quadrilateral is split between its first and third corner", "[scene]") {
    const Corners square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const auto triangles = triangulate(square);
    REQUIRE(triangles);
    CHECK(*triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 3, 0}});
    // An arrow head, concave at its first corner's neighbour, only splits the other way.
    const Corners arrow = {{0, 0, 0}, {1, 0.25F, 0}, {2, 0, 0}, {1, 2, 0}};
    const auto parts = triangulate(arrow);
    REQUIRE(parts);
    CHECK(parts->size() == 2);
    CHECK(area_of(arrow, *parts) == Approx(2 - 0.25));
}

TEST_CASE("Triangles cover the polygon, turn like it and do not overlap", "[scene]") {
    const glm::dvec3 center(3, -2, 1);
    const int points = GENERATE(3, 5, 36, 500);
    const auto [u, v] = GENERATE(table<glm::dvec3, glm::dvec3>({
        {{1, 0, 0}, {0, 1, 0}},
        {{0, 1, 0}, {1, 0, 0}},
        {{0, 0.6, 0.8}, {1, 0, 0}},
        {{0.48, 0.6, 0.64}, {0.8, 0, -0.6}},
    }));
    const Corners corners = star(points, u, v, center);
    const glm::dvec3 normal = newell_normal(corners);
    const auto triangles = triangulate(corners);
    REQUIRE(triangles);
    CHECK(triangles->size() == corners.size() - 2);
    for (const auto& [a, b, c] : *triangles) {
        CHECK(glm::dot(newell_normal(Corners{corners[a], corners[b], corners[c]}), normal) > 0);
    }
    // With all triangles turning alike, areas that overlapped would sum to more.
    CHECK(area_of(corners, *triangles) == Approx(glm::length(normal) / 2).epsilon(1e-6));
}

TEST_CASE("Triangulation of random simple polygons", "[scene]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.1, 1);
    for (int round = 0; round < 300; ++round) {
        // Star-shaped about the origin, so simple; corners at random distances.
        const int count = 4 + round % 60;
        Corners corners;
        for (int i = 0; i < count; ++i) {
            const double angle = 6.283185307 * i / count;
            const double radius = uniform(random);
            corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
        const auto triangles = triangulate(corners);
        REQUIRE(triangles);
        CHECK(triangles->size() == corners.size() - 2);
        CHECK(area_of(corners, *triangles) == Approx(glm::length(newell_normal(corners)) / 2).epsilon(1e-6));
        CHECK(triangulate(corners) == triangles);
    }
}

TEST_CASE("Repeated corners and corners on an edge leave no triangle without area", "[scene]") {
    const Corners corners = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                             {2, 2, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}, {0, 0, 0}};
    const auto triangles = triangulate(corners);
    REQUIRE(triangles);
    for (const auto& [a, b, c] : *triangles) CHECK_FALSE(is_degenerate(corners[a], corners[b], corners[c]));
    CHECK(area_of(corners, *triangles) == 4);
}

TEST_CASE("An outline that crosses itself has no triangulation", "[scene]") {
    // A bow tie with one wing larger: seen from the larger one's front the smaller turns the wrong way.
    const Corners bow = {{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 1, 0}};
    CHECK_FALSE(triangulate(bow));
}

TEST_CASE("A large concave patch takes no cubic time", "[scene]") {
    const Corners corners = star(2048, {1, 0, 0}, {0, 1, 0}, {0, 0, 0});
    const auto triangles = triangulate(corners);
    REQUIRE(triangles);
    CHECK(triangles->size() == corners.size() - 2);
}

}  // namespace sahl::tests
