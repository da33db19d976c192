// From what a batch lists to its jobs.
#pragma once

#include <span>
#include <vector>

#include "engine/batch/batch_job.h"
#include "engine/batch/manifest.h"

namespace sahl {

/// The most jobs of a batch.
inline constexpr std::size_t most_batch_jobs = 1'000'000;

/// The jobs of all entries in their order. Within an entry scenes change slowest, then parameters in their
/// order, then frames, then cameras: jobs that share a scene stand beside each other.
/// Throws SceneError at the entry, or Error(usage) where that is of the command line, for patterns that make
/// no names, names of no format that can hold what is asked for, two jobs that would write one file, and too
/// many jobs.
std::vector<BatchJob> expand_batch(std::span<const BatchEntry> entries);

}  // namespace sahl
