#include "cli/batch_messages.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>

namespace sahl::cli {

bool MessageSocket::send(const nlohmann::json& message) {
    // Paths in error messages may be no UTF-8, which JSON has to be.
    constexpr auto replace = nlohmann::json::error_handler_t::replace;
    const std::string line = message.dump(-1, ' ', false, replace) + "\n";
    std::string_view rest = line;
    const std::lock_guard lock(writing_);
    while (!rest.empty()) {
        const ssize_t count = ::send(file_, rest.data(), rest.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        rest.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

std::optional<nlohmann::json> MessageSocket::next() {
    const std::size_t end = received_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    nlohmann::json message = nlohmann::json::parse(received_.substr(0, end));
    received_.erase(0, end + 1);
    return message;
}

bool MessageSocket::receive() {
    std::array<char, 4096> bytes{};
    ssize_t count = 0;
    do {
        count = ::recv(file_, bytes.data(), bytes.size(), 0);
    } while (count < 0 && errno == EINTR);
    if (count <= 0) return false;
    received_.append(bytes.data(), static_cast<std::size_t>(count));
    return true;
}

}  // namespace sahl::cli
