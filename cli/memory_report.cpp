#include "cli/memory_report.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace sahl::cli {

std::string human_size(std::uint64_t bytes) {
    constexpr std::array units{"KiB", "MiB", "GiB", "TiB"};
    if (bytes < 1024) return fmt::format("{} B", bytes);
    double value = static_cast<double>(bytes) / 1024;
    std::size_t unit = 0;
    for (; value >= 1024 && unit + 1 < units.size(); ++unit) value /= 1024;
    return fmt::format("{:.2f} {}", value, units[unit]);
}

std::vector<std::pair<const char*, std::uint64_t>> memory_parts(const MemoryPlan& plan) {
    const SceneMemory& scene = plan.scene;
    return {{"scene_loaded", scene.loaded},
            {"scene_building", scene.building},
            {"bvh_nodes", scene.nodes},
            {"leaf_blocks", scene.leaf_blocks},
            {"shapes", scene.shapes},
            {"instances", scene.instances},
            {"materials", scene.materials},
            {"aovs", plan.aovs},
            {"aov_queues", plan.aov_queues},
            {"ray_queues", plan.ray_queues},
            {"film", plan.film},
            {"image", plan.image},
            {"encoder", plan.encoder},
            {"total", plan.total()}};
}

std::string memory_lines(const MemoryPlan& plan) {
    std::string lines;
    for (const auto& [name, bytes] : memory_parts(plan)) {
        std::string label(name);
        std::replace(label.begin(), label.end(), '_', ' ');
        lines += fmt::format("  {:<16}{:>12}\n", label, human_size(bytes));
    }
    return lines;
}

}  // namespace sahl::cli
