// Another process of this program that compiles some kernels of a program that has been built, while this one
// compiles the others: PoCL compiles one at a time in a process, whatever its threads.
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>

#include "engine/device/device.h"

namespace sahl {

/// Such a process, seen from the one that has started it; one at a time. It ends with the thread that has,
/// and its temporary files are in the other's folder.
class CompileHelper {
public:
    /// Has /proc/self/exe compile for `device`, see take_compile_order(). `options`: in the place of
    /// DeviceOptions::build_options. `built`: the program of that `key` as PoCL has built it, packed
    /// (pocl_programs.h). Nothing if no process can be started.
    static std::unique_ptr<CompileHelper> start(const Device& device, const std::string& options,
                                                const std::string& key, const std::string& built);
    /// Ends it.
    ~CompileHelper();
    /// Ends the one that is at work, and waits for that. Async-signal-safe.
    static void kill_running();
    CompileHelper(const CompileHelper&) = delete;
    CompileHelper& operator=(const CompileHelper&) = delete;

    /// Waits until it has ended. The program with the kernels that it has compiled, packed; nothing if it
    /// failed.
    std::string take();

private:
    CompileHelper(pid_t id, int output) : id_(id), output_(output) {}
    pid_t id_;
    int output_;
};

/// The device to compile for, if this process is a CompileHelper by its arguments. Puts the program where
/// PoCL finds it when it is built.
std::optional<DeviceOptions> take_compile_order(int argc, char** argv);

/// Hands over what a CompileHelper has compiled, and ends its process.
[[noreturn]] void deliver_compiled(const std::optional<std::string>& packed);

}  // namespace sahl
