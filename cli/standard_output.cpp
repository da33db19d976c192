#include "cli/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/sahl.h"

namespace sahl::cli {

void print(std::string_view text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!written || std::fflush(stdout) != 0) {
        throw Error(ExitCode::output,
                    fmt::format("standard output cannot be written: {}", std::strerror(errno)));
    }
}

void print_event(const nlohmann::ordered_json& event) {
    // Paths may be no UTF-8, which JSON has to be.
    constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
    print(event.dump(-1, ' ', false, replace) + "\n");
}

}  // namespace sahl::cli
