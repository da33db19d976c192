#include "bench/machine.h"

#include <embree3/rtcore_config.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/device/device.h"

namespace sahl::bench {
namespace {

/// What follows the first `key` and its separator in a file of /proc or /etc; "unknown" without one.
std::string value_of(const char* file, std::string_view key, char separator) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.rfind(key, 0) != 0) continue;
        const std::size_t start = line.find_first_not_of(" \t\"", line.find(separator) + 1);
        const std::size_t end = line.find_last_not_of(" \t\"");
        if (start != std::string::npos) return line.substr(start, end + 1 - start);
    }
    return "unknown";
}

/// The caches that the first core sees, as in "L1 Data 32K, L2 Unified 1024K".
std::string caches() {
    std::string text;
    for (int index = 0;; ++index) {
        const auto read = [&](const char* name) {
            std::ifstream in(fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/{}", index, name));
            std::string value;
            std::getline(in, value);
            return value;
        };
        const std::string level = read("level");
        if (level.empty()) return text;
        text += fmt::format("{}L{} {} {}", text.empty() ? "" : ", ", level, read("type"), read("size"));
    }
}

std::string opencl_driver() {
    std::string text;
    for (const DeviceInfo& device : list_devices()) {
        if (device.is_cpu)
            text += fmt::format("{}{}, {}", text.empty() ? "" : "; ", device.version, device.name);
    }
    return text;
}

}  // namespace

nlohmann::ordered_json machine_facts() {
    return {
        {"processor", value_of("/proc/cpuinfo", "model name", ':')},
        {"cores", std::thread::hardware_concurrency()},
        {"caches", caches()},
        {"memory", value_of("/proc/meminfo", "MemTotal", ':')},
        {"system", value_of("/etc/os-release", "PRETTY_NAME", '=')},
        {"sahl", SAHL_VERSION},
        {"embree", RTC_VERSION_STRING},
        {"opencl", opencl_driver()},
        {"compiler", "GCC " __VERSION__},
    };
}

void write_report(const nlohmann::ordered_json& report, const std::string& file) {
    std::ofstream out(file);
    out << report.dump(2) << '\n';
    out.close();
    if (!out)
        throw Error(ExitCode::output, fmt::format("{}: cannot be written: {}", file, std::strerror(errno)));
}

}  // namespace sahl::bench
