// What a render takes of memory, for people and for programs.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/memory_plan.h"

namespace sahl::cli {

/// "12 B", "3.40 MiB".
std::string human_size(std::uint64_t bytes);

/// The names of JSON and what they stand for, the total last.
std::vector<std::pair<const char*, std::uint64_t>> memory_parts(const MemoryPlan& plan);

/// A line for each part: "  ray queues         3.40 MiB".
std::string memory_lines(const MemoryPlan& plan);

}  // namespace sahl::cli
