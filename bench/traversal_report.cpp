#include "bench/traversal_report.h"

#include <cstdio>

#include <fmt/format.h>

namespace sahl::bench {
namespace {

/// Millions a second at the median.
double mrays(const TraversalCell& cell, const Runs& runs) {
    return static_cast<double>(cell.count) / spread_of(runs.seconds).median * 1e-6;
}

/// Sahl's speed over Embree's.
double ratio(const TraversalCell& cell, const std::vector<Runs>& embree) {
    return spread_of(best_of(embree).seconds).median / spread_of(best_of(cell.sahl).seconds).median;
}

Spread ratio_spread(const TraversalCell& cell, const std::vector<Runs>& embree) {
    return spread_of_quotients(best_of(embree).seconds, best_of(cell.sahl).seconds);
}

/// The cells of triangles, in which Embree's own triangles and its two modes are compared with.
bool is_mesh(const TraversalCell& cell) { return !cell.robust.empty(); }

struct Mean {
    std::string rays;
    double fast, robust, least;
};

std::vector<Mean> means(const std::vector<TraversalCell>& cells) {
    std::vector<Mean> means;
    for (const char* kind : ray_kinds) {
        std::vector<double> fast, robust;
        for (const TraversalCell& cell : cells) {
            if (cell.rays != kind || !is_mesh(cell)) continue;
            fast.push_back(ratio(cell, cell.embree));
            robust.push_back(ratio(cell, cell.robust));
        }
        if (!fast.empty())
            means.push_back({kind, geometric_mean(fast), geometric_mean(robust), spread_of(fast).min});
    }
    return means;
}

nlohmann::ordered_json runs_json(const TraversalCell& cell, const std::vector<Runs>& all) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const Runs& runs : all) json[runs.name] = mrays(cell, runs);
    return json;
}

nlohmann::ordered_json range_json(const Spread& spread) { return {spread.min, spread.max}; }

}  // namespace

void print_head() {
    fmt::print(
        "Mrays/s, medians; the ratio's spread over the repetitions; rays that differ from Embree's\n\n"
        "{:<13}{:<10}{:>8}  {:>7} {:<7} {:>7} {:<38}{:>5} {:<12}{:>7}{:>8}\n",
        "scene", "rays", "count", "Sahl", "kernel", "Embree", "by", "ratio", "spread", "robust", "differ");
    std::fflush(stdout);
}

void print_cell(const TraversalCell& cell) {
    const Runs &sahl = best_of(cell.sahl), &embree = best_of(cell.embree);
    const Spread spread = ratio_spread(cell, cell.embree);
    fmt::print("{:<13}{:<10}{:>8}  {:>7.2f} {:<7} {:>7.2f} {:<38}{:>5.2f} {:<12}{:>7}{:>8}\n", cell.scene,
               cell.rays, cell.count, mrays(cell, sahl), sahl.name, mrays(cell, embree),
               is_mesh(cell) ? embree.name : fmt::format("{}, {}", embree.name, cell.geometry),
               ratio(cell, cell.embree), fmt::format("{:.2f}..{:.2f}", spread.min, spread.max),
               is_mesh(cell) ? fmt::format("{:.2f}", ratio(cell, cell.robust)) : "", cell.differences.rays());
    std::fflush(stdout);
}

void print_means(const std::vector<TraversalCell>& cells) {
    if (means(cells).empty()) return;
    fmt::print("\nGeometric means over the meshes\n{:<10}{:>7}{:>8}{:>8}\n", "rays", "ratio", "robust",
               "least");
    for (const Mean& mean : means(cells))
        fmt::print("{:<10}{:>7.2f}{:>8.2f}{:>8.2f}\n", mean.rays, mean.fast, mean.robust, mean.least);
}

void print_differences(const std::vector<TraversalCell>& cells) {
    fmt::print(
        "\nRays that differ, and what double precision says of the primitives that both sides name\n"
        "{:<13}{:>9}{:>9}{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9}{:>9}\n"
        "{:<13}{:>9}{:>9}{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9}{:>9}\n",
        "", "of", "Sahl", "Embree", "other", "at an", "both", "Sahl", "Embree", "both", "scene", "millions",
        "misses", "misses", "distance", "outline", "right", "right", "right", "wrong");
    for (auto cell = cells.begin(); cell != cells.end();) {
        const std::string& scene = cell->scene;
        Differences sum;
        double rays = 0;
        for (; cell != cells.end() && cell->scene == scene; ++cell) {
            sum += cell->differences;
            rays += static_cast<double>(cell->count);
        }
        fmt::print("{:<13}{:>9.2f}{:>9}{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9}{:>9}\n", scene, 1e-6 * rays,
                   sum.sahl_misses, sum.embree_misses, sum.distances, sum.at_outline, sum.rounding,
                   sum.sahl_right, sum.embree_right, sum.both_wrong);
    }
}

nlohmann::ordered_json cell_json(const TraversalCell& cell) {
    const Runs &sahl = best_of(cell.sahl), &embree = best_of(cell.embree);
    const Differences& d = cell.differences;
    nlohmann::ordered_json json{
        {"mesh", cell.scene},
        {"rays", cell.rays},
        {"count", cell.count},
        {"sahl_mrays", mrays(cell, sahl)},
        {"sahl_kernel", sahl.name},
        {"embree_mrays", mrays(cell, embree)},
        {"embree_api", embree.name},
        {"embree_geometry", cell.geometry},
        {"ratio", ratio(cell, cell.embree)},
        {"ratio_spread", range_json(ratio_spread(cell, cell.embree))},
        {"mismatches", d.rays()},
        {"differences",
         {{"sahl_misses", d.sahl_misses},
          {"embree_misses", d.embree_misses},
          {"distances", d.distances},
          {"at_outline", d.at_outline},
          {"rounding", d.rounding},
          {"sahl_right", d.sahl_right},
          {"embree_right", d.embree_right},
          {"both_wrong", d.both_wrong}}},
        {"sahl_kernels", runs_json(cell, cell.sahl)},
        {"embree_apis", runs_json(cell, cell.embree)},
    };
    if (is_mesh(cell)) {
        const Runs& robust = best_of(cell.robust);
        json["ratio_robust"] = ratio(cell, cell.robust);
        json["ratio_robust_spread"] = range_json(ratio_spread(cell, cell.robust));
        json["robust_mrays"] = mrays(cell, robust);
        json["robust_api"] = robust.name;
        json["robust_mismatches"] = *cell.robust_mismatches;
    }
    return json;
}

nlohmann::ordered_json means_json(const std::vector<TraversalCell>& cells) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Mean& mean : means(cells))
        json.push_back({{"rays", mean.rays},
                        {"ratio", mean.fast},
                        {"ratio_robust", mean.robust},
                        {"least_ratio", mean.least}});
    return json;
}

}  // namespace sahl::bench
