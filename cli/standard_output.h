// Results on standard output. What cannot be written there is an error, not a short result.
#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace sahl::cli {

/// Writes `text` and flushes. Throws Error(output) when it does not get there.
void print(std::string_view text);

/// One event of the `--json` stream: `event` on a line of its own.
void print_event(const nlohmann::ordered_json& event);

}  // namespace sahl::cli
