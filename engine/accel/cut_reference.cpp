#include "engine/accel/cut_reference.h"

#include <array>

namespace sahl {

namespace {

Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }

// What the crossing of an edge may be off by. Of t = (plane - a) / (b - a) three roundings are no more than
// 3 * 2^-24; of a + (b - a) t the products are no more than |a| + |b| and add three. Twelve times 2^-24 of
// the larger of both is below 2^-20 of it; the summand is more than denormals lose.
Float4 margin(Float4 a, Float4 b) {
    const Float4 reach = larger(larger(a, -a), larger(b, -b));
    return reach * 0x1p-20F + 0x1p-120F;
}

}  // namespace

CutBoxes cut_triangle(const float* corners, const VectorBox& box, int axis, float plane) {
    const std::array<Float4, 3> v{Float4{corners[0], corners[1], corners[2], 0},
                                  Float4{corners[3], corners[4], corners[5], 0},
                                  Float4{corners[6], corners[7], corners[8], 0}};
    CutBoxes cut;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float4 a = v[i];
        const Float4 b = v[i == 2 ? 0 : i + 1];
        const float at_a = a[axis];
        const float at_b = b[axis];
        if (at_a <= plane) cut.below.extend(a, a);
        if (at_a >= plane) cut.above.extend(a, a);
        if ((at_a < plane && at_b > plane) || (at_a > plane && at_b < plane)) {
            const float t = (plane - at_a) / (at_b - at_a);
            const Float4 crossing = a + (b - a) * t;
            const Float4 off = margin(a, b);
            cut.below.extend(crossing - off, crossing + off);
            cut.above.extend(crossing - off, crossing + off);
        }
    }
    cut.below = intersection(cut.below, box);
    cut.above = intersection(cut.above, box);
    cut.below.hi[axis] = plane < cut.below.hi[axis] ? plane : cut.below.hi[axis];
    cut.above.lo[axis] = plane > cut.above.lo[axis] ? plane : cut.above.lo[axis];
    return cut;
}

}  // namespace sahl
