#include "engine/core/log.h"

#include <memory>

#include <spdlog/logger.h>
#include <spdlog/sinks/ansicolor_sink.h>

namespace sahl {

namespace {

/// The process's logger with its sink. Never destroyed: other statics may log in their destructors.
struct Log {
    std::shared_ptr<spdlog::sinks::ansicolor_stderr_sink_mt> sink =
        std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>(spdlog::color_mode::never);
    spdlog::logger logger{"sahl", sink};

    Log() {
        logger.set_pattern("sahl: %^%l%$: %v");
        logger.set_level(spdlog::level::warn);
        logger.flush_on(spdlog::level::trace);
    }
};

Log& log() {
    static Log* const instance = new Log;
    return *instance;
}

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::quiet:
            return spdlog::level::err;
        case LogLevel::normal:
            return spdlog::level::warn;
        case LogLevel::verbose:
            break;
    }
    return spdlog::level::debug;
}

}  // namespace

void set_log_level(LogLevel level) { log().logger.set_level(spdlog_level(level)); }

void set_log_color(bool color) {
    log().sink->set_color_mode(color ? spdlog::color_mode::always : spdlog::color_mode::never);
}

void log_error(std::string_view message) { log().logger.error("{}", message); }
void log_warning(std::string_view message) { log().logger.warn("{}", message); }
void log_debug(std::string_view message) { log().logger.debug("{}", message); }

}  // namespace sahl
