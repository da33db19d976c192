#include "engine/accel/partition.h"

#include <tuple>

namespace sahl {

void swap_ranges(std::span<const std::span<BuildPrimitive>> a, std::span<const std::span<BuildPrimitive>> b) {
    struct Swap {
        BuildPrimitive* a;
        BuildPrimitive* b;
        std::size_t size;
    };
    std::vector<Swap> swaps;
    std::size_t from_a = 0, from_b = 0;  // what of the first ranges is done
    while (!a.empty() && !b.empty()) {
        const std::size_t size = std::min(a.front().size() - from_a, b.front().size() - from_b);
        swaps.push_back({a.front().data() + from_a, b.front().data() + from_b, size});
        from_a += size;
        from_b += size;
        if (from_a == a.front().size()) {
            a = a.subspan(1);
            from_a = 0;
        }
        if (from_b == b.front().size()) {
            b = b.subspan(1);
            from_b = 0;
        }
    }
    tbb::parallel_for(std::size_t{0}, swaps.size(), [&](std::size_t i) {
        std::swap_ranges(swaps[i].a, swaps[i].a + swaps[i].size, swaps[i].b);
    });
}

Parted partition_by_rank(std::span<BuildPrimitive> primitives, int axis, std::size_t left_size) {
    const auto rank = [axis](const BuildPrimitive& p) {
        const auto& [lo, hi] = p.bounds;
        return std::tuple(lo[axis] + hi[axis], p.id, lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]);
    };
    std::nth_element(primitives.begin(), primitives.begin() + static_cast<std::ptrdiff_t>(left_size),
                     primitives.end(),
                     [&](const BuildPrimitive& a, const BuildPrimitive& b) { return rank(a) < rank(b); });
    return {summarise(primitives.first(left_size)), summarise(primitives.subspan(left_size))};
}

}  // namespace sahl
