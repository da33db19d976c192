// Takes the counts of kernels that count (kernels/count_visits.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/device.h"
#include "engine/render/visits.h"

namespace sahl {

/// Device memory of a VisitCounter.
std::size_t visit_counter_bytes(std::size_t places);

/// Where counting kernels put their counts, and the sums so far.
class VisitCounter {
public:
    /// For launches that count in `places` at most, rays or work-items, and a ray tree of `depth` generations
    /// after the first.
    VisitCounter(Device& device, std::size_t places, int depth);

    /// The kernels' last argument, zeroed for the next launch. Waits for the queue.
    const Buffer& next();

    /// Adds the counts of the last launch, in `places`, to `sums`. Waits for it.
    void add_to(KernelVisits& sums, std::size_t places, std::uint64_t& lit);

    /// Adds the last launch's counts by ray to the rays' pixels; `rays`: what each of them stands for.
    void add_to_pixels(std::span<const std::uint32_t> pixel_of, std::span<const std::uint32_t> rays);

    std::vector<GenerationVisits> generations;
    /// Of kernels that count by ray alone.
    PixelVisits pixels;

private:
    Buffer counts_;
    std::size_t places_;
};

}  // namespace sahl
