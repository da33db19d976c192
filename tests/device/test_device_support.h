// What the tests of engine/device share.
#pragma once

#include <stdlib.h>  // NOLINT: setenv

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "engine/core/error.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {

/// An environment variable that has its old value again at the end of the scope.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const std::string& value) : name_(name) {
        if (const char* old = getenv(name)) old_ = old;
        setenv(name, value.c_str(), 1);
    }
    ~ScopedVariable() {
        if (old_) {
            setenv(name_, old_->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* name_;
    std::optional<std::string> old_;
};

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The message of the Error that `action` throws; fails the test unless it has `code`.
template <class Action>
std::string error_of(ExitCode code, Action action) {
    try {
        action();
    } catch (const Error& error) {
        CHECK(static_cast<int>(error.code()) == static_cast<int>(code));
        return error.what();
    }
    FAIL("no Error was thrown");
    return {};
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace sahl::tests
