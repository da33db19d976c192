#include "engine/scene/scene_json_groups.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

// Visits the instances depth first, with a stack of its own: groups may be nested thousands deep.
// Returns the groups in an order in which each comes after those that it contains.
std::vector<std::uint32_t> order_groups(const JsonSceneState& state) {
    enum class Visit : char { none, open, done };
    struct Step {
        std::uint32_t group;
        std::size_t next_instance;
    };
    std::vector<Visit> visits(state.groups.size(), Visit::none);
    std::vector<std::uint32_t> order;
    std::vector<Step> path;
    for (std::uint32_t start = 0; start < state.groups.size(); ++start) {
        if (visits[start] != Visit::none) continue;
        path.push_back({start, 0});
        visits[start] = Visit::open;
        while (!path.empty()) {
            Step& step = path.back();
            const Placed& group = state.groups[step.group];
            if (step.next_instance == group.instances.size()) {
                visits[step.group] = Visit::done;
                order.push_back(step.group);
                path.pop_back();
                continue;
            }
            const std::size_t instance = step.next_instance++;
            const std::uint32_t next = group.instances[instance].group;
            if (visits[next] == Visit::open) {
                std::string cycle;
                for (const Step& s : path) {
                    if (s.group == next || !cycle.empty()) cycle += state.group_names[s.group] + " -> ";
                }
                state.reader.fail(
                    *group.instance_values[instance],
                    fmt::format("the group {} contains itself: {}{}; remove this instance",
                                in_quotes(state.group_names[next]), cycle, state.group_names[next]));
            }
            if (visits[next] == Visit::none) {
                visits[next] = Visit::open;
                path.push_back({next, 0});
            }
        }
    }
    return order;
}

// Groups of groups multiply: counted before the renderer places them, and at the instance to change.
void check_placements(const JsonSceneState& state, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint64_t> counts(state.groups.size());  // of the instances inside
    std::vector<int> nesting(state.groups.size(), 1);
    const auto count = [&](const Placed& placed) {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < placed.instances.size(); ++i) {
            const std::uint32_t group = placed.instances[i].group;
            sum += 1 + counts[group];  // neither is above the limit
            if (sum <= max_placed) continue;
            state.reader.fail(*placed.instance_values[i],
                              fmt::format("with this instance of the group {} more than {} groups are "
                                          "placed, the most there can be; place fewer",
                                          in_quotes(state.group_names[group]), max_placed));
        }
        return sum;
    };
    for (const std::uint32_t index : order) {
        const Placed& group = state.groups[index];
        for (std::size_t i = 0; i < group.instances.size(); ++i) {
            nesting[index] = std::max(nesting[index], nesting[group.instances[i].group] + 1);
            if (nesting[index] <= max_group_nesting) continue;
            state.reader.fail(
                *group.instance_values[i],
                fmt::format("groups nest deeper than {} with this instance of the group {}; "
                            "nest them less",
                            max_group_nesting, in_quotes(state.group_names[group.instances[i].group])));
        }
        counts[index] = count(group);
    }
    count(state.world);
}

}  // namespace

void check_groups(const JsonSceneState& state) {
    const Scene& scene = state.scene;
    std::vector<Extent> extents(state.groups.size());
    const auto instance_extent = [&](const Placed& placed, std::size_t i) {
        const Instance& instance = placed.instances[i];
        const Extent extent = extents[instance.group].transformed(scene.transforms[instance.transform]);
        if (!extent.within(max_magnitude)) {
            state.reader.fail(*placed.instance_values[i],
                              fmt::format("here the group {} reaches beyond ±{:g}; scale or move it less",
                                          in_quotes(state.group_names[instance.group]), max_magnitude));
        }
        return extent;
    };
    const std::vector<std::uint32_t> order = order_groups(state);
    check_placements(state, order);
    for (const std::uint32_t index : order) {
        const Placed& group = state.groups[index];
        for (const Primitive& p : group.primitives) {
            extents[index].add(extent_of(scene, p).transformed(scene.transforms[p.transform]));
        }
        for (std::size_t i = 0; i < group.instances.size(); ++i) {
            extents[index].add(instance_extent(group, i));
        }
    }
    for (std::size_t i = 0; i < state.world.instances.size(); ++i) instance_extent(state.world, i);
}

}  // namespace sahl
