// What tests of output need: files, and the rights of an ordinary user.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace sahl::tests::film {

/// The rights of a user who is not root, while it lives.
class NoPrivileges {
public:
    NoPrivileges() {
        if (user_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("seteuid failed");
    }
    ~NoPrivileges() {
        if (::seteuid(user_) != 0) std::abort();
    }

private:
    uid_t user_ = ::geteuid();
};

inline std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void put(const std::filesystem::path& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

}  // namespace sahl::tests::film
