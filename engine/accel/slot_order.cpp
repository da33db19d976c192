#include "engine/accel/slot_order.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace sahl {

namespace {

// A box's cost in a slot with the numbers of both: they sort by cost, then by box, then by slot.
using Candidate = std::int64_t;

constexpr Candidate no_candidate = INT64_MAX;

Candidate candidate(float cost, std::size_t box, std::size_t slot) {
    // Floats sort as their bits do, of negative ones the lower 31 turned round; there is one zero.
    const auto bits = std::bit_cast<std::int32_t>(cost + 0.0F);
    const std::int64_t sorting = bits < 0 ? bits ^ 0x7fffffff : bits;
    return sorting * 64 + static_cast<std::int64_t>(box * 8 + slot);
}
std::size_t box_of(Candidate c) { return static_cast<std::size_t>(c >> 3 & 7); }
std::size_t slot_of(Candidate c) { return static_cast<std::size_t>(c & 7); }

using Candidates = std::array<Candidate, 8>;

Candidate least(const Candidates& c) {
    return std::min(std::min(std::min(c[0], c[1]), std::min(c[2], c[3])),
                    std::min(std::min(c[4], c[5]), std::min(c[6], c[7])));
}

}  // namespace

std::array<int, 8> assign_slots(std::span<const Bounds> boxes) {
    Bounds all = empty_bounds();
    for (const Bounds& box : boxes) extend(all, box);

    // A box's cost is how far it lies along the direction of the slot's octant, whose rays visit it first.
    std::array<Candidates, 8> slots_of_box;
    Candidates best;
    best.fill(no_candidate);
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        std::array<float, 3> offset{};
        for (std::size_t k = 0; k < 3; ++k) {
            offset[k] = (boxes[b].lo[k] - all.lo[k]) + (boxes[b].hi[k] - all.hi[k]);
        }
        for (std::size_t s = 0; s < 8; ++s) {
            const float cost = ((s & 1) != 0 ? -offset[0] : offset[0]) +
                               ((s & 2) != 0 ? -offset[1] : offset[1]) +
                               ((s & 4) != 0 ? -offset[2] : offset[2]);
            slots_of_box[b][s] = candidate(cost, b, s);
        }
        best[b] = least(slots_of_box[b]);
    }

    std::array<int, 8> slots{};
    unsigned taken = 0;
    for (std::size_t step = 0; step < boxes.size(); ++step) {
        const Candidate next = least(best);
        const std::size_t slot = slot_of(next);
        slots[box_of(next)] = static_cast<int>(slot);
        taken |= 1u << slot;
        best[box_of(next)] = no_candidate;
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            slots_of_box[b][slot] = no_candidate;
            if (best[b] != no_candidate && slot_of(best[b]) == slot) best[b] = least(slots_of_box[b]);
        }
    }
    for (std::size_t b = boxes.size(); b < 8; ++b) {
        const int slot = std::countr_one(taken);
        slots[b] = slot;
        taken |= 1u << slot;
    }
    return slots;
}

}  // namespace sahl
