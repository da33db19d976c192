// What a set of references is like as a whole, which the search for a split must know before it looks at them
// one by one. Sides are summarised while a set is parted.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/accel/bvh.h"
#include "engine/accel/vector_box.h"

namespace sahl {

struct SetSummary {
    VectorBox box;
    VectorBox centroids;  ///< of lo + hi, twice the centroid
    std::size_t size = 0;
    std::uint32_t kinds = 0;  ///< bit k: there are some of kind k

    void add(const BuildPrimitive& reference) {
        const Float4 lo = load_lo(reference);
        const Float4 hi = load_hi(reference);
        box.extend(lo, hi);
        centroids.extend(lo + hi, lo + hi);
        ++size;
        kinds |= 1u << (reference.kind & 31u);
    }
    SetSummary operator+(const SetSummary& other) const {
        return {box.with(other.box), centroids.with(other.centroids), size + other.size, kinds | other.kinds};
    }
    /// The least of the kinds that there are.
    std::uint32_t first_kind() const { return static_cast<std::uint32_t>(std::countr_zero(kinds)); }
    /// Whether there are several.
    bool mixed() const { return (kinds & (kinds - 1)) != 0; }
};

SetSummary summarise(std::span<const BuildPrimitive> references);

/// The same of primitives that a tree is to be built over. -0 becomes +0 in their bounds: as -0 == +0, which
/// of them a minimum keeps would depend on the order. Throws Error(internal) if a kind is unknown.
SetSummary check_and_summarise(std::span<BuildPrimitive> primitives);

}  // namespace sahl
