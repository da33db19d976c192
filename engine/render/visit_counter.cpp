#include "engine/render/visit_counter.h"

#include <algorithm>
#include <limits>

#include "kernels/device_types.h"

namespace sahl {
namespace {

std::size_t count_bytes(std::size_t places) { return places * SAHL_COUNTS * sizeof(std::uint64_t); }

void add_saturated(std::uint32_t& sum, std::uint64_t value) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    sum = static_cast<std::uint32_t>(std::min(most, sum + value));
}

}  // namespace

std::size_t visit_counter_bytes(std::size_t places) { return Buffer::footprint(count_bytes(places)); }

VisitCounter::VisitCounter(Device& device, std::size_t places, int depth)
    : generations(static_cast<std::size_t>(depth) + 1),
      counts_(device, count_bytes(places), "visits"),
      places_(places) {}

const Buffer& VisitCounter::next() {
    const auto counts = counts_.map<std::uint64_t>(MapMode::write, places_ * SAHL_COUNTS);
    std::fill(counts.begin(), counts.end(), 0);
    return counts_;
}

void VisitCounter::add_to(KernelVisits& sums, std::size_t places, std::uint64_t& lit) {
    const auto counts = counts_.map<std::uint64_t>(MapMode::read, places * SAHL_COUNTS);
    for (std::size_t place = 0; place < places; ++place) {
        const std::uint64_t* of_place = counts.data() + place * SAHL_COUNTS;
        sums.nodes += of_place[SAHL_COUNT_NODES];
        sums.leaves += of_place[SAHL_COUNT_LEAVES];
        sums.leaf_bytes += of_place[SAHL_COUNT_LEAF_BYTES];
        sums.flop += of_place[SAHL_COUNT_FLOP];
        lit += of_place[SAHL_COUNT_LIT];
    }
}

void VisitCounter::add_to_pixels(std::span<const std::uint32_t> pixel_of,
                                 std::span<const std::uint32_t> rays) {
    if (!pixels.rays.empty()) {
        for (std::size_t i = 0; i < rays.size(); ++i) add_saturated(pixels.rays[pixel_of[i]], rays[i]);
    }
    if (pixels.nodes.empty()) return;
    const auto counts = counts_.map<std::uint64_t>(MapMode::read, rays.size() * SAHL_COUNTS);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        add_saturated(pixels.nodes[pixel_of[i]], counts[i * SAHL_COUNTS + SAHL_COUNT_NODES]);
    }
}

}  // namespace sahl
