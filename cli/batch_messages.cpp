#include "cli/batch_messages.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace sahl::cli {

namespace {

using Size = std::uint32_t;  // both ends are the same program

}  // namespace

bool MessageSocket::send(const nlohmann::json& message) {
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_msgpack(message);
    const auto size = static_cast<Size>(bytes.size());
    std::string text(reinterpret_cast<const char*>(&size), sizeof(size));
    text.append(bytes.begin(), bytes.end());
    std::string_view rest = text;
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
    Size size = 0;
    if (received_.size() < sizeof(size)) return std::nullopt;
    std::memcpy(&size, received_.data(), sizeof(size));
    const std::size_t end = sizeof(size) + size;
    if (received_.size() < end) return std::nullopt;
    const auto text = std::string_view(received_).substr(sizeof(size), size);
    nlohmann::json message = nlohmann::json::from_msgpack(text);
    received_.erase(0, end);
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
