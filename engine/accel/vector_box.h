// Boxes as pairs of four-float vectors (the vector extension of g++ and clang): the builder spends
// its time on minima and maxima of boxes, and this makes each one instruction. Lane 3 of every
// vector here is a by-catch without meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "engine/accel/bvh.h"

namespace sahl {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

static_assert(sizeof(BuildPrimitive) == 32, "a BuildPrimitive is two vectors");

inline Float4 load_lo(const BuildPrimitive& primitive) {
    Float4 lo;
    std::memcpy(&lo, &primitive, sizeof lo);
    return lo;
}

inline Float4 load_hi(const BuildPrimitive& primitive) {
    Float4 hi;
    std::memcpy(&hi, reinterpret_cast<const char*>(&primitive) + offsetof(Bounds, hi), sizeof hi);
    return hi;
}

/// Makes two primitives trade places, by vectors: whoever reads one soon after as vectors would have to wait
/// for stores of single numbers.
inline void trade_places(BuildPrimitive& a, BuildPrimitive& b) {
    Float4 of_a[2], of_b[2];
    std::memcpy(of_a, &a, sizeof a);
    std::memcpy(of_b, &b, sizeof b);
    std::memcpy(&a, of_b, sizeof a);
    std::memcpy(&b, of_a, sizeof b);
}

/// A box that starts empty.
struct VectorBox {
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    Float4 lo{infinity, infinity, infinity, infinity};
    Float4 hi{-infinity, -infinity, -infinity, -infinity};

    void extend(Float4 other_lo, Float4 other_hi) {
        lo = other_lo < lo ? other_lo : lo;
        hi = other_hi > hi ? other_hi : hi;
    }
    void extend(const VectorBox& other) { extend(other.lo, other.hi); }
    /// A box around both.
    VectorBox with(VectorBox other) const {
        other.extend(*this);
        return other;
    }
    int longest_axis() const {
        const Float4 extent = hi - lo;
        const int of_xy = extent[1] > extent[0] ? 1 : 0;
        return extent[2] > extent[of_xy] ? 2 : of_xy;
    }
    Bounds bounds() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

inline VectorBox box_of(const BuildPrimitive& primitive) { return {load_lo(primitive), load_hi(primitive)}; }

inline double half_area(const VectorBox& box) { return half_area(box.bounds()); }

/// Whether a box contains nothing.
inline bool is_empty(const VectorBox& box) {
    return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

/// What two boxes have in common, which may be nothing.
inline VectorBox intersection(const VectorBox& a, const VectorBox& b) {
    return {a.lo > b.lo ? a.lo : b.lo, a.hi < b.hi ? a.hi : b.hi};
}

}  // namespace sahl
