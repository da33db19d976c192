#include "engine/accel/slot_order.h"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/host/accel/boxes.h"

using namespace sahl;
using namespace sahl::test;

namespace {

std::vector<Bounds> octant_boxes(float spread) {
    std::vector<Bounds> boxes;
    for (unsigned octant = 0; octant < 8; ++octant) {
        const auto at = [&](unsigned bit) { return (octant >> bit & 1u) != 0 ? spread : -spread; };
        boxes.push_back(cube(at(0), at(1), at(2), 1));
    }
    return boxes;
}

}  // namespace

TEST_CASE("boxes in the octants sit in the slots of their octants", "[bvh]") {
    std::vector<Bounds> boxes = octant_boxes(5);
    std::vector<int> octants{0, 1, 2, 3, 4, 5, 6, 7};
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        for (std::size_t i = 8; i > 1; --i) {
            const std::size_t j = random() % i;
            std::swap(boxes[i - 1], boxes[j]);
            std::swap(octants[i - 1], octants[j]);
        }
        const auto slots = assign_slots(boxes);
        CHECK(std::equal(octants.begin(), octants.end(), slots.begin()));
    }
}

TEST_CASE("rays of every octant visit separate boxes front to back", "[bvh]") {
    const std::vector<Bounds> boxes = octant_boxes(5);
    const auto slots = assign_slots(boxes);
    for (int octant = 0; octant < 8; ++octant) {
        // Of two boxes that differ along one axis, the ray meets the one on its side first.
        for (std::size_t a = 0; a < 8; ++a) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t b = a ^ std::size_t{1} << axis;
                const bool negative = (octant >> axis & 1) != 0;
                const bool a_is_near = (boxes[a].lo[axis] < boxes[b].lo[axis]) != negative;
                CHECK(((slots[a] ^ octant) < (slots[b] ^ octant)) == a_is_near);
            }
        }
    }
}

TEST_CASE("every number of boxes gets slots of its own", "[bvh]") {
    std::mt19937 random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<Bounds> boxes(static_cast<std::size_t>(round % 9));
        for (Bounds& box : boxes)
            box = cube(uniform(random), uniform(random), uniform(random), uniform(random));
        auto slots = assign_slots(boxes);
        std::sort(slots.begin(), slots.end());
        for (int i = 0; i < 8; ++i) CHECK(slots[static_cast<std::size_t>(i)] == i);
    }
}

TEST_CASE("two boxes are visited front to back along the axis that parts them", "[bvh]") {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Bounds near = cube(0, 0, 0, 1);
        Bounds far = near;
        far.lo[axis] += 4;
        far.hi[axis] += 4;
        const std::vector<Bounds> boxes{far, near};
        const auto slots = assign_slots(boxes);
        for (int octant = 0; octant < 8; ++octant) {
            const bool negative = (octant >> axis & 1) != 0;
            CHECK(((slots[1] ^ octant) < (slots[0] ^ octant)) != negative);
        }
    }
}
