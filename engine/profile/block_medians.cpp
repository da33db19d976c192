#include "engine/profile/block_medians.h"

#include <algorithm>

#include "engine/profile/statistics.h"

namespace sahl {
namespace {

std::vector<double>& samples_of(ProfileTimes& times, const TimedRow& row) {
    const auto same = [&](const TimedRow& other) { return name_of(other) == name_of(row); };
    const auto found = std::find_if(times.rows.begin(), times.rows.end(), same);
    if (found != times.rows.end()) return found->samples_ms;
    return times.rows.emplace_back(TimedRow{row.kernel, row.generation, {}}).samples_ms;
}

}  // namespace

void append_block(std::array<ProfileTimes, 2>& all, const std::array<ProfileTimes, 2>& block) {
    for (const TimedRow& row : block[0].rows) samples_of(all[0], row).push_back(median(row.samples_ms));
    for (const TimedRow& row : block[1].rows) {
        const TimedRow* const base = find_row(block[0], name_of(row));
        const double time =
            base == nullptr ? median(row.samples_ms)
                            : median(base->samples_ms) * ratio_of({base->samples_ms, row.samples_ms, true});
        samples_of(all[1], row).push_back(time);
    }
    for (const std::size_t side : {0U, 1U}) all[side].environment = block[side].environment;
}

}  // namespace sahl
