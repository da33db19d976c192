// Work that may crash or never end, done by a child process: this one lives on and can say so.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace sahl {

/// One end of a pipe between two processes.
class PipeEnd {
public:
    explicit PipeEnd(int file) : file_(file) {}
    /// False when nobody reads any more.
    bool write(std::span<const std::byte> bytes) const;
    /// Fills `bytes`; false when the writer has gone before.
    bool read(std::span<std::byte> bytes) const;

private:
    int file_;
};

/// Runs `work` in a copy of this process (fork), with standard input, output and error closed, and
/// meanwhile `receive` in this process, to read what `work` writes. Returns "" when `work` came to its
/// end, otherwise what it did in words that follow a subject: "crashes (Segmentation fault)", "takes more
/// time than it should". What `work` throws counts as a crash; when `receive` throws, the child is killed.
///
/// For a process whose other threads, if it has any, are idle: the copy has none of them, and no hope of a
/// lock that one held.
/// Throws Error(memory) if there is no room for another process.
std::string run_in_child(const std::function<void(PipeEnd)>& work,
                         const std::function<void(PipeEnd)>& receive);

/// From now on this process may take `bytes` more of memory, beyond which allocations fail, and
/// `seconds` more of processor time, or a few times that by the clock, beyond which it dies (and
/// run_in_child says so). A later call replaces an earlier one's limits.
void limit_process(std::size_t bytes, std::size_t seconds);

}  // namespace sahl
