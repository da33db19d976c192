#include "tests/host/accel/triangles.h"

#include <array>
#include <random>

#include "tests/host/accel/boxes.h"

namespace sahl::test {

namespace {

using Point = std::array<float, 3>;
using Corners = std::array<Point, 3>;

Point random_point(std::mt19937& random, float size) {
    Point p;
    for (float& x : p) x = size * (2 * uniform(random) - 1);
    return p;
}

Point sum(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Corners make_corners(Triangles kind, std::size_t i, std::mt19937& random) {
    const Point a = random_point(random, 1);
    const Point b = random_point(random, 1);
    const Point near_a = sum(a, random_point(random, 0.01F));
    switch (kind) {
        case Triangles::small:
            return {a, near_a, sum(a, random_point(random, 0.01F))};
        case Triangles::crossed:
            return {a, near_a, b};
        case Triangles::beams:
            return {a, near_a, i % 10 == 0 ? b : sum(a, random_point(random, 0.01F))};
        case Triangles::giant:
            if (i == 0) return {Point{-1, -1, -1}, Point{1, 1, -1}, Point{-1, 1, 1}};
            return {a, near_a, sum(a, random_point(random, 0.01F))};
        case Triangles::slivers: {
            const float t = uniform(random);
            return {a, Point{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])},
                    b};
        }
        case Triangles::identical:
            return {Point{-1, -0.9F, -0.8F}, Point{0.7F, 1, 0.9F}, Point{1, 0.8F, 1}};
        case Triangles::lines:
            return {a, b, b};
        case Triangles::points:
            return {a, a, a};
        case Triangles::far:
            return {sum(random_point(random, 1e15F), Point{1e15F, 0, 0}), random_point(random, 1e15F),
                    random_point(random, 1e15F)};
        case Triangles::flat:
            return {Point{a[0], a[1], 0}, Point{b[0], b[1], 0}, Point{a[2], b[2], 0}};
    }
    return {};
}

}  // namespace

TriangleSet make_triangles(Triangles kind, std::size_t size, std::uint32_t seed) {
    std::mt19937 random(seed);
    TriangleSet set;
    for (std::size_t i = 0; i < size; ++i) {
        const auto id = static_cast<std::uint32_t>(i);
        set.lowered.push_back({SAHL_KIND_TRIANGLE, 0, 9 * id, 0});
        Bounds bounds = empty_bounds();
        for (const Point& p : make_corners(kind, i, random)) {
            set.data.insert(set.data.end(), p.begin(), p.end());
            extend(bounds, {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}});
        }
        set.primitives.push_back({bounds, SAHL_KIND_TRIANGLE, id});
    }
    return set;
}

}  // namespace sahl::test
