#include "engine/accel/slot_order.h"

#include <bit>
#include <cstddef>
#include <limits>

namespace sahl {

std::array<int, 8> assign_slots(std::span<const Bounds> boxes) {
    Bounds all = empty_bounds();
    for (const Bounds& box : boxes) extend(all, box);

    // cost[b][s]: how far box b lies along the direction of octant s, whose rays visit slot s
    // first.
    std::array<std::array<float, 8>, 8> cost{};
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        std::array<float, 3> offset{};
        for (std::size_t k = 0; k < 3; ++k) {
            offset[k] = (boxes[b].lo[k] - all.lo[k]) + (boxes[b].hi[k] - all.hi[k]);
        }
        for (std::size_t s = 0; s < 8; ++s) {
            cost[b][s] = ((s & 1) != 0 ? -offset[0] : offset[0]) + ((s & 2) != 0 ? -offset[1] : offset[1]) +
                         ((s & 4) != 0 ? -offset[2] : offset[2]);
        }
    }

    // Of each box that has none yet, the best slot that is left.
    std::array<std::size_t, 8> best{};
    unsigned taken = 0;
    const auto find_best = [&](std::size_t b) {
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t s = 0; s < 8; ++s) {
            if ((taken >> s & 1u) == 0 && cost[b][s] < least) {
                least = cost[b][s];
                best[b] = s;
            }
        }
    };
    for (std::size_t b = 0; b < boxes.size(); ++b) find_best(b);

    std::array<int, 8> slot_of{};
    slot_of.fill(-1);
    for (std::size_t step = 0; step < boxes.size(); ++step) {
        std::size_t box = boxes.size();
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            if (slot_of[b] < 0 && (box == boxes.size() || cost[b][best[b]] < cost[box][best[box]])) box = b;
        }
        const std::size_t slot = best[box];
        slot_of[box] = static_cast<int>(slot);
        taken |= 1u << slot;
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            if (slot_of[b] < 0 && best[b] == slot) find_best(b);
        }
    }
    for (std::size_t b = boxes.size(); b < 8; ++b) {
        const int slot = std::countr_one(taken);
        slot_of[b] = slot;
        taken |= 1u << slot;
    }
    return slot_of;
}

}  // namespace sahl
