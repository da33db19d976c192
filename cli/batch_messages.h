// What the supervisor of a batch and its worker say to each other over a socket: for each message its size in
// bytes, four of them, and JSON as MessagePack, where texts may be no UTF-8.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace sahl::cli {

/// One end of the socket. Messages are written whole, from any thread; read by one thread.
class MessageSocket {
public:
    explicit MessageSocket(int file) : file_(file) {}

    /// False when the other side is gone.
    bool send(const nlohmann::json& message);

    /// The next message if a whole one has arrived already.
    std::optional<nlohmann::json> next();
    /// Reads what is there; waits for something if there is nothing. False when the other side is gone.
    bool receive();

    int file() const { return file_; }
    /// Another end, where there was none.
    void reset(int file) { file_ = file; }

private:
    int file_;
    std::mutex writing_;
    std::string received_{};
};

}  // namespace sahl::cli
