// The comparison as a table and as JSON.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "bench/traversal_cell.h"

namespace sahl::bench {

/// To standard output: the table's head, a row, and the geometric means of the kinds of rays over the meshes.
void print_head();
void print_cell(const TraversalCell& cell);
void print_means(const std::vector<TraversalCell>& cells);
/// The differing rays of all cells, scene by scene.
void print_differences(const std::vector<TraversalCell>& cells);

/// Millions of rays a second, ratios Sahl over Embree's best way, spreads from least to largest over the
/// repetitions, and the rays that differ.
nlohmann::ordered_json cell_json(const TraversalCell& cell);
nlohmann::ordered_json means_json(const std::vector<TraversalCell>& cells);

}  // namespace sahl::bench
