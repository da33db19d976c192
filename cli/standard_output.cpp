#include "cli/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

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

void print_message(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

void reserve_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        // It gets the lowest number that is free. Writing there fails, as it would without.
        if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) < 0) return;
    }
}

}  // namespace sahl::cli
