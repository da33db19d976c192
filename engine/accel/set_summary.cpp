#include "engine/accel/set_summary.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "engine/accel/parallel_chunks.h"

namespace sahl {

SetSummary summarise(std::span<const BuildPrimitive> references) {
    const auto add = [&](std::size_t begin, std::size_t end, SetSummary summary) {
        for (std::size_t i = begin; i < end; ++i) summary.add(references[i]);
        return summary;
    };
    if (references.size() < parallel_set_size) return add(0, references.size(), {});
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, references.size(), parallel_grain), SetSummary{},
        [&](const auto& range, const SetSummary& summary) {
            return add(range.begin(), range.end(), summary);
        },
        [](SetSummary summary, const SetSummary& other) {
            summary.add(other);
            return summary;
        });
}

}  // namespace sahl
