// Results on standard output, where what cannot be written is an error and not a short result; and messages
// on standard error.
#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace sahl::cli {

/// Writes `text` and flushes. Throws Error(output) when it does not get there.
void print(std::string_view text);

/// One event of the `--json` stream: `event` on a line of its own.
void print_event(const nlohmann::ordered_json& event);

/// Writes `text` to standard error, as far as somebody reads it: a log on a full disk ends no work.
void print_message(std::string_view text);

/// Lets files that the process opens never take the place of a standard stream that it was started without,
/// where they would be written over.
void reserve_standard_streams();

}  // namespace sahl::cli
