// A page that shows a batch: contact sheet, times, failures.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/batch_outcome.h"
#include "cli/batch_setup.h"

namespace sahl::cli {

/// Writes the page, which needs no other file. Throws Error(output).
void write_batch_page(const std::filesystem::path& path, const BatchSetup& setup,
                      const std::vector<JobOutcome>& outcomes);

}  // namespace sahl::cli
