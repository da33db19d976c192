#include "engine/accel/pre_split.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/accel/set_summary.h"
#include "tests/host/accel/triangles.h"

using namespace sahl;
using namespace sahl::test;

namespace {

// Right triangles whose legs lie along x and y, the first as long as is said, the others of length 1.
TriangleSet right_triangles(std::size_t size, float first_leg) {
    TriangleSet set;
    for (std::uint32_t id = 0; id < size; ++id) {
        const float leg = id == 0 ? first_leg : 1;
        const float x = static_cast<float>(id % 100), y = static_cast<float>(id / 100);
        const float corners[] = {x, y, 0, x + leg, y, 0, x, y + leg, 0};
        set.data.insert(set.data.end(), std::begin(corners), std::end(corners));
        set.lowered.push_back({SAHL_KIND_TRIANGLE, 0, 9 * id, 0});
        set.primitives.push_back({{{x, y, 0}, {x + leg, y + leg, 0}}, SAHL_KIND_TRIANGLE, id});
    }
    return set;
}

std::vector<BuildPrimitive> pre_split(const TriangleSet& set) {
    std::vector<BuildPrimitive> references = set.primitives;
    pre_split(references, summarise(references).box, set.corners());
    return references;
}

}  // namespace

TEST_CASE("pre-splitting: a long triangle gets the cuts that its length is worth, and others none", "[bvh]") {
    for (const float leg : {1.0F, 1.5F, 10.0F, 100.0F}) {
        const TriangleSet set = right_triangles(10000, leg);
        // The box of a right triangle is as wide as its leg. Its parts' boxes cover half of it at least.
        const double mean = (9999 + static_cast<double>(leg)) / 10000;
        const double cuts = leg < 2 * mean ? 0 : std::floor(2 * std::sqrt(leg * std::sqrt(0.5) / mean));
        CAPTURE(leg);
        const std::vector<BuildPrimitive> references = pre_split(set);
        CHECK(references.size() == 10000 + static_cast<std::size_t>(cuts));
        double area = 0;
        for (const BuildPrimitive& reference : references) {
            if (reference.id == 0) area += half_area(reference.bounds);
        }
        CHECK(area >= 0.5 * leg * leg);
        if (cuts > 0) CHECK(area < 0.8 * leg * leg);
    }
}

TEST_CASE("pre-splitting: where many triangles are long their cuts share what room there is", "[bvh]") {
    const TriangleSet set = make_triangles(Triangles::beams, 20000, 1);
    const std::size_t size = pre_split(set).size();
    CHECK(size <= most_references(20000));
    CHECK(size > 23000);
}

TEST_CASE("pre-splitting: what is no triangle, and a set that is a point, stay as they are", "[bvh]") {
    TriangleSet set = right_triangles(10000, 100);
    set.primitives[0].kind = SAHL_KIND_SPHERE;
    CHECK(pre_split(set).size() == 10000);
    CHECK(pre_split(make_triangles(Triangles::points, 1, 1)).size() == 1);
}
