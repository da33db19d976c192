// Takes the counts of kernels that count (kernels/count_visits.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/device.h"
#include "engine/render/visits.h"

namespace sahl {

/// Where counting kernels put their counts, and the sums so far.
class VisitCounter {
public:
    /// For launches of `work_items` at most and a ray tree of `depth` generations after the first.
    VisitCounter(Device& device, std::size_t work_items, int depth);

    /// The kernels' last argument, zeroed for the next launch. Waits for the queue.
    const Buffer& next();

    /// Adds the counts of the last launch, of `work_items`, to `sums`. Waits for it.
    void add_to(KernelVisits& sums, std::size_t work_items, std::uint64_t& lit);

    std::vector<GenerationVisits> generations;

private:
    Buffer counts_;
    std::size_t work_items_;
};

}  // namespace sahl
