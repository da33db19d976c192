#include "bench/peak_memory.h"

#include <fstream>
#include <string>

#include <malloc.h>

namespace sahl::bench {
namespace {

/// A line of /proc/self/status, in bytes.
std::uint64_t status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        if (word != name) continue;
        std::uint64_t kibibytes = 0;
        status >> kibibytes;
        return kibibytes << 10U;
    }
    return 0;
}

}  // namespace

std::uint64_t peak_growth(const std::function<void()>& work) {
    malloc_trim(0);  // what earlier work has left would be used again and not be counted
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;
    if (!reset) return 0;
    const std::uint64_t before = status_bytes("VmRSS:");
    work();
    const std::uint64_t peak = status_bytes("VmHWM:");
    return peak > before ? peak - before : 0;
}

}  // namespace sahl::bench
