#include "engine/profile/timeline.h"

#include <algorithm>

namespace sahl {
namespace {

struct BusyInterval {
    std::uint64_t begin = 0, end = 0;
};

/// When launches ran, within the record: disjoint, ascending.
std::vector<BusyInterval> busy_intervals(const TimelineRecord& record) {
    std::vector<BusyInterval> intervals;
    for (const LaunchRecord& launch : record.launches) {
        const std::uint64_t begin = std::clamp(launch.started_ns, record.begin_ns, record.end_ns);
        const std::uint64_t end = std::clamp(launch.ended_ns, record.begin_ns, record.end_ns);
        if (begin < end) intervals.push_back({begin, end});
    }
    std::sort(intervals.begin(), intervals.end(),
              [](const BusyInterval& a, const BusyInterval& b) { return a.begin < b.begin; });
    std::vector<BusyInterval> merged;
    for (const BusyInterval& interval : intervals) {
        if (!merged.empty() && interval.begin <= merged.back().end) {
            merged.back().end = std::max(merged.back().end, interval.end);
        } else {
            merged.push_back(interval);
        }
    }
    return merged;
}

}  // namespace

std::vector<HostSegment> host_segments(const TimelineRecord& record) {
    std::vector<HostSegment> segments;
    std::vector<const char*> open;
    std::uint64_t from = record.begin_ns;
    const auto close_segment = [&](std::uint64_t to) {
        to = std::clamp(to, from, record.end_ns);
        if (to > from) segments.push_back({from, to, open.empty() ? nullptr : open.back()});
        from = to;
    };
    for (const HostEvent& event : record.steps) {
        close_segment(event.ns);
        if (event.begins != nullptr) {
            open.push_back(event.begins);
        } else if (!open.empty()) {
            open.pop_back();
        }
    }
    close_segment(record.end_ns);
    return segments;
}

TimelineSums add_up(const TimelineRecord& record) {
    const std::vector<BusyInterval> busy = busy_intervals(record);
    TimelineSums sums;
    for (const BusyInterval& interval : busy) sums.busy_ns += interval.end - interval.begin;
    sums.idle_ns = record.end_ns - record.begin_ns - sums.busy_ns;
    for (const HostEvent& event : record.steps) {
        if (event.begins != nullptr) ++sums.steps[event.begins].calls;
    }
    auto next = busy.begin();
    for (const HostSegment& segment : host_segments(record)) {
        while (next != busy.end() && next->end <= segment.begin_ns) ++next;
        std::uint64_t overlap = 0;
        for (auto interval = next; interval != busy.end() && interval->begin < segment.end_ns; ++interval) {
            overlap += std::min(interval->end, segment.end_ns) - std::max(interval->begin, segment.begin_ns);
        }
        const std::uint64_t length = segment.end_ns - segment.begin_ns;
        if (segment.step == nullptr) {
            sums.unattributed_ns += length - overlap;
            continue;
        }
        HostStepTime& step = sums.steps[segment.step];
        step.total_ns += length;
        step.exposed_ns += length - overlap;
    }
    for (const HiddenStep& hidden : record.hidden) sums.steps[hidden.name].total_ns += hidden.ns;
    return sums;
}

}  // namespace sahl
