// The oracle's discs, boxes and closed cones, sides and surface coordinates by hand.
#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/oracle/build_scene.h"
#include "engine/oracle/oracle.h"

namespace sahl::oracle {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

bool equal_vectors(const dvec3& a, const dvec3& b) { return glm::distance(a, b) < 1e-12; }
bool equal_vectors(const dvec2& a, const dvec2& b) { return glm::distance(a, b) < 1e-12; }

std::optional<Hit> solid_hit(const Scene& scene, const Ray& ray, const SurfaceId& start = {}) {
    return Oracle(scene).closest_hit(ray, 0, infinity, start);
}

TEST_CASE("oracle: a disc is round and has a front", "[oracle]") {
    Scene scene;
    add_disc(scene, {{1, 2, 3}, {0, 0, 5}, 2}, {});
    const auto hit = solid_hit(scene, {{1, 3, 7}, {0, 0, -2}});
    REQUIRE(hit);
    CHECK(hit->t == Approx(2));
    CHECK(equal_vectors(hit->ng, {0, 0, 1}));
    CHECK(hit->uv.y == Approx(0.5));
    CHECK_FALSE(solid_hit(scene, {{1, 4.01, 7}, {0, 0, -1}}));
    CHECK_FALSE(solid_hit(scene, {{2.5, 3.5, 7}, {0, 0, -1}}));  // a corner of the square around it
    CHECK(Oracle(scene).edge_distance({{1, 4.01, 7}, {0, 0, -1}}) == Approx(0.005));
    CHECK_FALSE(solid_hit(scene, {{1, 2, 3}, {0, 0, 1}}, hit->id));
    // u turns about the normal: a quarter turn from the first place is a quarter.
    const auto u_at = [&](double degrees) {
        const double angle = glm::radians(degrees);
        return solid_hit(scene, {{1 + std::cos(angle), 2 + std::sin(angle), 9}, {0, 0, -1}})->uv.x;
    };
    for (const double degrees : {10.0, 100.0, 190.0, 280.0}) {
        const double quarter = u_at(degrees + 90) - u_at(degrees);
        CHECK(quarter - std::floor(quarter) == Approx(0.25));
    }
}

TEST_CASE("oracle: a box has six faces with their places", "[oracle]") {
    Scene scene;
    add_box(scene, {{1, 2, 3}, {3, 6, 11}}, {});
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const dvec3 lo(1, 2, 3), hi(3, 6, 11);
            const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
            dvec3 origin = lo + 0.25 * (hi - lo), direction(0), normal(0);
            origin[second] = lo[second] + 0.75 * (hi - lo)[second];
            normal[axis] = side;
            direction[axis] = -side;
            origin[axis] = side > 0 ? hi[axis] + 3 : lo[axis] - 3;
            const auto hit = solid_hit(scene, {origin, direction});
            REQUIRE(hit);
            CHECK(hit->t == Approx(3));
            CHECK(equal_vectors(hit->ng, normal));
            CHECK(equal_vectors(hit->uv, {0.25, 0.75}));
            // From this face: inwards the opposite one, outwards nothing.
            const auto through = solid_hit(scene, {hit->position, direction}, hit->id);
            REQUIRE(through);
            CHECK(through->t == Approx((hi - lo)[axis]));
            CHECK(equal_vectors(through->ng, -normal));
            CHECK_FALSE(solid_hit(scene, {hit->position, -direction}, hit->id));
            // Just past an edge.
            dvec3 beside = origin;
            beside[first] = lo[first] - 1e-9;
            CHECK_FALSE(solid_hit(scene, {beside, direction}));
        }
    }
    // Through a corner at a slant: a chord.
    const auto corner = solid_hit(scene, {{0, 2.5, 3.5}, {1, -0.25, 0}});
    REQUIRE(corner);
    CHECK(corner->t == Approx(1));
    const auto out = solid_hit(scene, {corner->position, {1, -0.25, 0}}, corner->id);
    REQUIRE(out);
    CHECK(out->t == Approx(1));
    CHECK(equal_vectors(out->ng, {0, -1, 0}));
}

TEST_CASE("oracle: capped cones and cylinders are solid", "[oracle]") {
    Scene scene;
    add_cone(scene, {{0, 0, 0}, {0, 0, 4}, 2, 1, true}, {});
    const auto base = solid_hit(scene, {{1.5, 0, -3}, {0, 0, 1}});
    REQUIRE(base);
    CHECK(base->t == Approx(3));
    CHECK(equal_vectors(base->ng, {0, 0, -1}));
    CHECK(base->uv.y == 0);
    const auto side = solid_hit(scene, {base->position, {0, 0, 1}}, base->id);
    REQUIRE(side);
    CHECK(side->t == Approx(2));
    CHECK(equal_vectors(side->ng, glm::normalize(dvec3(4, 0, 1))));
    CHECK(side->uv.y == Approx(0.5));
    const auto top = solid_hit(scene, {{0.5, 0.5, 9}, {0, 0, -1}});
    REQUIRE(top);
    CHECK(top->t == Approx(5));
    CHECK(equal_vectors(top->ng, {0, 0, 1}));
    CHECK(top->uv.y == 1);
    const auto bottom = solid_hit(scene, {top->position, {0, 0, -1}}, top->id);
    REQUIRE(bottom);
    CHECK(bottom->t == Approx(4));
    CHECK_FALSE(solid_hit(scene, {top->position, {0, 0, 1}}, top->id));
    CHECK_FALSE(solid_hit(scene, {{2.01, 0, -3}, {0, 0, 1}}));

    Scene pointed;
    add_cone(pointed, {{0, 0, 0}, {0, 0, 2}, 0, 1, true}, {});
    const auto lid = solid_hit(pointed, {{0.25, 0, 5}, {0, 0, -1}});
    REQUIRE(lid);
    CHECK(lid->t == Approx(3));
    const auto wall = solid_hit(pointed, {lid->position, {0, 0, -1}}, lid->id);
    REQUIRE(wall);
    CHECK(wall->t == Approx(1.5));

    Scene drum;
    add_cone(drum, {{0, 0, 0}, {3, 0, 0}, 1, 1, true}, {});
    const auto along = solid_hit(drum, {{-1, 0.5, 0.5}, {1, 0, 0}});
    REQUIRE(along);
    CHECK(along->t == Approx(1));
    CHECK(solid_hit(drum, {along->position, {1, 0, 0}}, along->id)->t == Approx(3));
    CHECK_FALSE(solid_hit(drum, {{-1, 0.8, 0.8}, {1, 0, 0}}));
}

TEST_CASE("oracle: sides of flat and of solid things", "[oracle]") {
    const auto only = [](Sides sides, const auto& add, const Ray& ray) {
        Scene scene;
        add(scene);
        scene.primitives.back().sides = sides;
        return solid_hit(scene, ray);
    };
    const Ray down{{0.1, 0.2, 5}, {0, 0, -1}}, up{{0.1, 0.2, -5}, {0, 0, 1}};
    const std::vector<void (*)(Scene&)> flats{
        [](Scene& scene) {
            add_disc(scene, {{0, 0, 0}, {0, 0, 1}, 1}, {});
        },
        [](Scene& scene) { add_square(scene, 0, 1, {}); },
        [](Scene& scene) {
            add_triangle(scene, {{-2, -2, 0}, {2, -2, 0}, {0, 3, 0}}, {});
        }};
    for (const auto& add : flats) {
        CHECK(only(Sides::front, add, down));
        CHECK_FALSE(only(Sides::front, add, up));
        CHECK(only(Sides::back, add, up));
        CHECK_FALSE(only(Sides::back, add, down));
    }
    const std::vector<void (*)(Scene&)> solids{[](Scene& scene) {
                                                   add_box(scene, {{-1, -1, -1}, {1, 1, 1}}, {});
                                               },
                                               [](Scene& scene) {
                                                   add_cone(scene, {{0, 0, -1}, {0, 0, 1}, 1, 1, true}, {});
                                               }};
    for (const auto& add : solids) {
        CHECK(only(Sides::front, add, down)->t == Approx(4));
        CHECK(only(Sides::back, add, down)->t == Approx(6));
    }
}

TEST_CASE("oracle: surface coordinates of spheres, cones, triangles and polygons", "[oracle]") {
    Scene scene;
    add_sphere(scene, {{0, 0, 0}, 1}, {});
    const auto on_sphere = [&](const dvec3& at) { return solid_hit(scene, {3.0 * at, -at})->uv; };
    CHECK(equal_vectors(on_sphere({1, 0, 0}), {0, 0.5}));
    CHECK(equal_vectors(on_sphere({0, 1, 0}), {0.25, 0.5}));
    CHECK(equal_vectors(on_sphere({0, -1, 0}), {0.75, 0.5}));
    CHECK(on_sphere({0, 0, 1}).y == Approx(1));
    CHECK(on_sphere({0, 0, -1}).y == Approx(0).margin(1e-12));
    CHECK(on_sphere(glm::normalize(dvec3(1, 0, 1))).y == Approx(0.75));

    Scene pipe;
    add_cone(pipe, {{0, 0, 1}, {0, 0, 5}, 1, 1}, {});
    const auto on_pipe = [&](double degrees, double z) {
        const double angle = glm::radians(degrees);
        const dvec3 out(std::cos(angle), std::sin(angle), 0);
        return solid_hit(pipe, {5.0 * out + dvec3(0, 0, z), -out})->uv;
    };
    CHECK(on_pipe(10, 2).y == Approx(0.25));
    const double quarter = on_pipe(100, 2).x - on_pipe(10, 2).x;
    CHECK(quarter - std::floor(quarter) == Approx(0.25));

    Scene mesh;
    add_triangle(mesh, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {}, glm::scale(dmat4(1), dvec3(-1, 1, 1)));
    CHECK(equal_vectors(solid_hit(mesh, {{-1, 2, 1}, {0, 0, -1}})->uv, {0.25, 0.5}));
    mesh.uvs = {{0, 0}, {8, 0}, {0, 2}};
    mesh.triangles[0].has_uv = true;
    for (std::uint32_t i = 0; i < 3; ++i) mesh.triangles[0].uvs[i] = i;
    CHECK(equal_vectors(solid_hit(mesh, {{-1, 2, 1}, {0, 0, -1}})->uv, {2, 1}));
    CHECK(equal_vectors(solid_hit(mesh, {{-1, 2, 1}, {0, 0, -1}})->barycentric, {0.25, 0.5}));

    Scene floor;
    add_polygon(floor, {{1, 1, 0}, {1, 5, 0}, {-2, 5, 0}, {-2, 1, 0}}, {});
    CHECK(equal_vectors(solid_hit(floor, {{-1, 4, 1}, {0, 0, -1}})->uv, {3, 2}));
}

}  // namespace
}  // namespace sahl::oracle
