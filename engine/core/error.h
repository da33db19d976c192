// Every failure that a user can meet is an Error: a message that says what, where and what to do,
// with the exit status the program ends with.
#pragma once

#include <stdexcept>
#include <string>

namespace sahl {

/// Exit statuses of the `sahl` program.
enum class ExitCode : int {
    ok = 0,
    compare_failed = 1,
    usage = 2,
    scene = 3,
    device = 4,
    memory = 5,
    output = 6,
    resume_mismatch = 7,
    jobs_failed = 8,
    performance = 9,
    internal = 70,
};

/// An error with the exit status it stands for. `what()` is complete: what, where, what to do.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// A place in a text file. Lines and columns count from 1; columns count bytes.
struct SourceLocation {
    std::string file;
    int line = 1;
    int column = 1;
};

/// `file:line:column: message`, exit status 3.
class SceneError : public Error {
public:
    SceneError(const SourceLocation& where, const std::string& message)
        : Error(ExitCode::scene, where.file + ":" + std::to_string(where.line) + ":" +
                                     std::to_string(where.column) + ": " + message) {}
};

}  // namespace sahl
