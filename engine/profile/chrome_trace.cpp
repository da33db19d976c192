#include "engine/profile/chrome_trace.h"

#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sahl {
namespace {

using Json = nlohmann::ordered_json;

constexpr int host_process = 1;
constexpr int device_process = 2;

class Trace {
public:
    explicit Trace(std::uint64_t start_ns) : start_ns_(start_ns) {
        name_process(host_process, "host");
        name_process(device_process, "device");
        name_track(host_process, 0, "steps");
    }

    void add(const TimelineRecord& record, const std::string& name) {
        add_slice(host_process, 0, name, record.begin_ns, record.end_ns);
        add_steps(record);
        for (std::size_t i = 0; i < record.launches.size();) i = add_flow(record, i);
    }

    std::string text() const {
        const Json trace{{"displayTimeUnit", "ms"}, {"traceEvents", events_}};
        return trace.dump() + '\n';
    }

private:
    double microseconds(std::uint64_t ns) const {
        return (static_cast<double>(ns) - static_cast<double>(start_ns_)) * 1e-3;
    }

    void name_process(int process, const char* name) {
        events_.push_back({{"ph", "M"},
                           {"name", "process_name"},
                           {"pid", process},
                           {"tid", 0},
                           {"args", {{"name", name}}}});
    }

    void name_track(int process, int track, const std::string& name) {
        events_.push_back({{"ph", "M"},
                           {"name", "thread_name"},
                           {"pid", process},
                           {"tid", track},
                           {"args", {{"name", name}}}});
    }

    Json& add_slice(int process, int track, const std::string& name, std::uint64_t begin, std::uint64_t end) {
        events_.push_back({{"ph", "X"},
                           {"name", name},
                           {"pid", process},
                           {"tid", track},
                           {"ts", microseconds(begin)},
                           {"dur", static_cast<double>(end - begin) * 1e-3}});
        return events_.back();
    }

    void add_steps(const TimelineRecord& record) {
        std::vector<HostEvent> open;
        for (const HostEvent& event : record.steps) {
            if (event.begins != nullptr) {
                open.push_back(event);
            } else if (!open.empty()) {
                add_slice(host_process, 0, open.back().begins, open.back().ns, event.ns);
                open.pop_back();
            }
        }
    }

    int track_of(const std::string& kernel) {
        const auto [track, is_new] = tracks_.try_emplace(kernel, static_cast<int>(tracks_.size()) + 1);
        if (is_new) name_track(device_process, track->second, kernel);
        return track->second;
    }

    /// The launches of one generation from launch `first` on; returns the first of the next.
    std::size_t add_flow(const TimelineRecord& record, std::size_t first) {
        const std::vector<LaunchRecord>& launches = record.launches;
        const std::uint32_t generation = launches[first].generation;
        std::size_t end = first;
        while (end < launches.size() && launches[end].generation == generation) ++end;
        ++flows_;
        for (std::size_t i = first; i < end; ++i) {
            const LaunchRecord& launch = launches[i];
            const int track = track_of(launch.kernel);
            add_slice(device_process, track, launch.kernel, launch.started_ns, launch.ended_ns)["args"] = {
                {"generation", generation},
                {"items", launch.items},
                {"lanes", launch.lanes},
                {"queued_us", microseconds(launch.queued_ns)},
                {"submitted_us", microseconds(launch.submitted_ns)}};
            if (end - first < 2) continue;
            Json flow{{"ph", i == first     ? "s"
                             : i + 1 == end ? "f"
                                            : "t"},
                      {"name", fmt::format("generation {}", generation)},
                      {"cat", "generation"},
                      {"id", flows_},
                      {"pid", device_process},
                      {"tid", track},
                      {"ts", microseconds(launch.started_ns)}};
            if (i + 1 == end) flow["bp"] = "e";  // the slice around it, not the next one
            events_.push_back(std::move(flow));
        }
        return end;
    }

    std::uint64_t start_ns_;
    Json events_ = Json::array();
    std::map<std::string, int> tracks_;
    std::uint64_t flows_ = 0;
};

}  // namespace

std::string chrome_trace(const Measurement& measurement) {
    Trace trace(measurement.setup.begin_ns);
    trace.add(measurement.setup, "setup");
    for (std::size_t i = 0; i < measurement.frames.size(); ++i) {
        trace.add(measurement.frames[i], fmt::format("repetition {}", i));
    }
    return trace.text();
}

}  // namespace sahl
