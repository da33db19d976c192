// Axis-aligned boxes in float, as the tree stores them, and what the builder does with them.
#pragma once

#include <limits>

namespace sahl {

struct Bounds {
    float lo[3];
    float hi[3];
};

/// The box that contains nothing: the identity of extend().
inline Bounds empty_bounds() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

/// Exact and independent of order (of boxes without negative zeros), so that sums over threads
/// are the same bits however the work was cut.
inline void extend(Bounds& bounds, const Bounds& other) {
    for (int k = 0; k < 3; ++k) {
        bounds.lo[k] = other.lo[k] < bounds.lo[k] ? other.lo[k] : bounds.lo[k];
        bounds.hi[k] = other.hi[k] > bounds.hi[k] ? other.hi[k] : bounds.hi[k];
    }
}

/// Half the surface of a box that is not empty. In double: boxes of 1e-30 or 1e15 times many
/// primitives stay far from under- and overflow. A flat box has an area, a line has none.
inline double half_area(const Bounds& bounds) {
    const double x = static_cast<double>(bounds.hi[0]) - static_cast<double>(bounds.lo[0]);
    const double y = static_cast<double>(bounds.hi[1]) - static_cast<double>(bounds.lo[1]);
    const double z = static_cast<double>(bounds.hi[2]) - static_cast<double>(bounds.lo[2]);
    return x * y + y * z + z * x;
}

}  // namespace sahl
