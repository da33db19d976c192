// What the engine says on the side: lines on standard error, `sahl: warning: …`.
#pragma once

#include <string_view>

namespace sahl {

/// What is shown: errors alone; errors and warnings; everything.
enum class LogLevel { quiet, normal, verbose };

/// Counts for the whole process; the start is `normal` without colour.
void set_log_level(LogLevel level);
void set_log_color(bool color);

/// One line each, thread-safe. `message` has no line break at its end.
void log_error(std::string_view message);
void log_warning(std::string_view message);
void log_debug(std::string_view message);

}  // namespace sahl
