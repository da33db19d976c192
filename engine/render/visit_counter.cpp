#include "engine/render/visit_counter.h"

#include <algorithm>

#include "kernels/device_types.h"

namespace sahl {
namespace {

std::size_t whole_groups(const Device& device, std::size_t work_items) {
    return (work_items + device.local_size() - 1) / device.local_size() * device.local_size();
}

}  // namespace

VisitCounter::VisitCounter(Device& device, std::size_t work_items, int depth)
    : generations(static_cast<std::size_t>(depth) + 1),
      counts_(device, whole_groups(device, work_items) * SAHL_COUNTS * sizeof(std::uint64_t), "visits"),
      work_items_(whole_groups(device, work_items)) {}

const Buffer& VisitCounter::next() {
    const auto counts = counts_.map<std::uint64_t>(MapMode::write, work_items_ * SAHL_COUNTS);
    std::fill(counts.begin(), counts.end(), 0);
    return counts_;
}

void VisitCounter::add_to(KernelVisits& sums, std::size_t work_items, std::uint64_t& lit) {
    const auto counts = counts_.map<std::uint64_t>(MapMode::read, work_items * SAHL_COUNTS);
    for (std::size_t item = 0; item < work_items; ++item) {
        const std::uint64_t* of_item = counts.data() + item * SAHL_COUNTS;
        sums.nodes += of_item[SAHL_COUNT_NODES];
        sums.leaves += of_item[SAHL_COUNT_LEAVES];
        sums.leaf_bytes += of_item[SAHL_COUNT_LEAF_BYTES];
        sums.flop += of_item[SAHL_COUNT_FLOP];
        lit += of_item[SAHL_COUNT_LIT];
    }
}

}  // namespace sahl
