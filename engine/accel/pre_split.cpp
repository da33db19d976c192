#include "engine/accel/pre_split.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "engine/accel/cut_reference.h"
#include "engine/accel/parallel_chunks.h"
#include "engine/accel/split_sweep.h"

namespace sahl {

namespace {

// A box is as wide as the root of half its area. A triangle is long if its box is so many times as wide as
// boxes are on average.
constexpr double long_width = 2;
// How many cuts a triangle gets whose box exceeds its need by as much as a box of average width has.
constexpr double cuts_of_average = 2;

struct LongTriangle {
    std::size_t reference;
    double cuts;  ///< that it should get
};

// Sums of whole numbers do not depend on their order. Widths are at most 2, so that there are at most
// 2 (2 n)^(1/2) cuts of a triangle of n, and sums of both stay below 2^63.
std::uint64_t fixed_point(double x) { return static_cast<std::uint64_t>(x * 0x1p20); }
double from_fixed_point(std::uint64_t x) { return static_cast<double>(x) * 0x1p-20; }

struct Splitter {
    std::vector<BuildPrimitive>& references;
    const TriangleCorners& corners;
    float scale;  ///< of lengths

    float area_of(const BuildPrimitive& reference) const;
    double excess_of(const BuildPrimitive& reference) const;
    std::vector<LongTriangle> find_long() const;
    void cut(std::size_t reference, std::size_t cuts, std::atomic<std::size_t>& end) const;
};

// Half the area of its box.
float Splitter::area_of(const BuildPrimitive& reference) const {
    const Float4 e = (load_hi(reference) - load_lo(reference)) * scale;
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

// By how much half the area of a triangle's box exceeds that of all boxes of its parts, were it cut into very
// many: these are then as large as the triangle's shadows along the axes.
double Splitter::excess_of(const BuildPrimitive& reference) const {
    const float* v = corners.of(reference.id);
    const auto side = [&](int corner, int axis) {
        return (static_cast<double>(v[3 * corner + axis]) - static_cast<double>(v[axis])) * scale;
    };
    const auto shadow = [&](int i, int k) {
        return std::abs(side(1, i) * side(2, k) - side(1, k) * side(2, i)) / 2;
    };
    return static_cast<double>(area_of(reference)) - (shadow(0, 1) + shadow(1, 2) + shadow(2, 0));
}

// The number of cuts grows with the root of lengths. Measured: where it grows faster, the longest triangles
// take the cuts from those of medium length, and trees cost more.
std::vector<LongTriangle> Splitter::find_long() const {
    const std::uint64_t sum = sum_chunks(0, references.size(), [&](std::size_t begin, std::size_t end) {
        std::uint64_t widths = 0;
        for (std::size_t i = begin; i < end; ++i) widths += fixed_point(std::sqrt(area_of(references[i])));
        return widths;
    });
    const double mean = from_fixed_point(sum) / static_cast<double>(references.size());
    std::vector<LongTriangle> all;
    if (mean == 0) return all;
    const auto long_area = static_cast<float>(long_width * mean * long_width * mean);
    std::mutex mutex;
    for_chunks(references.size(), [&](std::size_t begin, std::size_t end) {
        std::vector<LongTriangle> some;
        for (std::size_t i = begin; i < end; ++i) {
            const BuildPrimitive& reference = references[i];
            if (reference.kind != SAHL_KIND_TRIANGLE || area_of(reference) < long_area) continue;
            const double excess = excess_of(reference);
            if (excess > 0) some.push_back({i, cuts_of_average * std::sqrt(std::sqrt(excess) / mean)});
        }
        if (some.empty()) return;
        const std::scoped_lock lock(mutex);
        all.insert(all.end(), some.begin(), some.end());
    });
    return all;
}

// Cuts a reference at the middle of its box, and each half with half of the other cuts.
void Splitter::cut(std::size_t reference, std::size_t cuts, std::atomic<std::size_t>& end) const {
    const VectorBox box = box_of(references[reference]);
    const int axis = box.longest_axis();
    const float middle = box.lo[axis] * 0.5F + box.hi[axis] * 0.5F;
    const CutBoxes halves = cut_triangle(corners.of(references[reference].id), box, axis, middle);
    if (is_empty(halves.below) || is_empty(halves.above)) return;
    const std::size_t other = end++;
    references[other] = references[reference];
    references[reference].bounds = halves.below.bounds();
    references[other].bounds = halves.above.bounds();
    if (cuts / 2 > 0) cut(other, cuts / 2, end);
    if ((cuts - 1) / 2 > 0) cut(reference, (cuts - 1) / 2, end);
}

}  // namespace

void pre_split(std::vector<BuildPrimitive>& references, const VectorBox& box,
               const TriangleCorners& corners) {
    const std::size_t size = references.size();
    const Splitter splitter{references, corners, Price::scale_of(box)};
    const std::vector<LongTriangle> triangles = splitter.find_long();
    std::uint64_t wanted = 0;
    for (const LongTriangle& triangle : triangles) wanted += fixed_point(triangle.cuts) + 1;
    const auto room = static_cast<double>(most_references(size) - size);
    const double share = std::min(1.0, room / from_fixed_point(wanted));
    const auto cuts_of = [&](const LongTriangle& triangle) {
        return static_cast<std::size_t>(triangle.cuts * share);
    };
    std::size_t cuts = 0;
    for (const LongTriangle& triangle : triangles) cuts += cuts_of(triangle);
    references.resize(size + cuts);
    std::atomic<std::size_t> end = size;
    for_chunks(triangles.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (cuts_of(triangles[i]) > 0) splitter.cut(triangles[i].reference, cuts_of(triangles[i]), end);
        }
    });
    references.resize(end);
}

}  // namespace sahl
