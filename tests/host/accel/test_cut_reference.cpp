#include "engine/accel/cut_reference.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "tests/host/accel/boxes.h"
#include "tests/host/accel/triangles.h"

using namespace sahl;
using namespace sahl::test;

namespace {

struct Exact {
    long double x[3];
};

bool contains(const VectorBox& box, const Exact& p) {
    for (int k = 0; k < 3; ++k) {
        if (p.x[k] < static_cast<long double>(box.lo[k]) || p.x[k] > static_cast<long double>(box.hi[k])) {
            return false;
        }
    }
    return true;
}

bool within(const VectorBox& box, const VectorBox& outer) {
    if (is_empty(box)) return true;
    for (int k = 0; k < 3; ++k) {
        if (box.lo[k] < outer.lo[k] || box.hi[k] > outer.hi[k]) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("spatial splits: the boxes of a cut contain their sides of the triangle and lie within its box",
          "[bvh]") {
    std::mt19937 random(1);
    int crossings = 0;
    for (const Triangles kind : all_triangles) {
        const TriangleSet set = make_triangles(kind, 300, 7);
        for (const BuildPrimitive& primitive : set.primitives) {
            const float* v = set.corners().of(primitive.id);
            const VectorBox box = box_of(primitive);
            const int axis = static_cast<int>(random() % 3);
            // Through the box, and now and then through a corner.
            float plane = box.lo[axis] + uniform(random) * (box.hi[axis] - box.lo[axis]);
            if (random() % 4 == 0) plane = v[3 * (random() % 3) + static_cast<unsigned>(axis)];
            CAPTURE(static_cast<int>(kind), primitive.id, axis, plane);
            const CutBoxes cut = cut_triangle(v, box, axis, plane);
            CHECK(within(cut.below, box));
            CHECK(within(cut.above, box));
            if (!is_empty(cut.below)) CHECK(cut.below.hi[axis] <= plane);
            if (!is_empty(cut.above)) CHECK(cut.above.lo[axis] >= plane);
            for (int i = 0; i < 3; ++i) {
                const float* a = v + 3 * i;
                const float* b = v + 3 * ((i + 1) % 3);
                const Exact corner{{a[0], a[1], a[2]}};
                if (a[axis] <= plane) CHECK(contains(cut.below, corner));
                if (a[axis] >= plane) CHECK(contains(cut.above, corner));
                if (!(std::min(a[axis], b[axis]) < plane && plane < std::max(a[axis], b[axis]))) continue;
                ++crossings;
                const auto start = static_cast<long double>(a[axis]);
                const long double t =
                    (static_cast<long double>(plane) - start) / (static_cast<long double>(b[axis]) - start);
                Exact crossing{};
                for (int k = 0; k < 3; ++k) {
                    const auto from = static_cast<long double>(a[k]);
                    crossing.x[k] = k == axis ? static_cast<long double>(plane)
                                              : from + (static_cast<long double>(b[k]) - from) * t;
                }
                CHECK(contains(cut.below, crossing));
                CHECK(contains(cut.above, crossing));
            }
        }
    }
    CHECK(crossings > 3000);
}

TEST_CASE("spatial splits: a triangle beside the plane is on its side alone, one in it on both", "[bvh]") {
    const float above[] = {0, 0, 1, 1, 0, 1, 0, 1, 2};
    const VectorBox box{{0, 0, 1, 0}, {1, 1, 2, 0}};
    CHECK(is_empty(cut_triangle(above, box, 2, 0.5F).below));
    CHECK(!is_empty(cut_triangle(above, box, 2, 0.5F).above));
    CHECK(is_empty(cut_triangle(above, box, 2, 2.5F).above));
    const float in_plane[] = {0, 0, 1, 1, 0, 1, 0, 1, 1};
    const VectorBox flat{{0, 0, 1, 0}, {1, 1, 1, 0}};
    const CutBoxes cut = cut_triangle(in_plane, flat, 2, 1);
    CHECK(within(flat, cut.below));
    CHECK(within(flat, cut.above));
}
