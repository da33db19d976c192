#include "engine/profile/environment.h"

#include <fstream>
#include <string>

#include <fmt/format.h>

#include "engine/core/hash.h"
#include "engine/device/kernel_source.h"
#include "engine/render/launches.h"

namespace sahl {
namespace {

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

}  // namespace

void describe_device(const Device& device, ProfileEnvironment& environment) {
    const DeviceInfo& info = device.info();
    environment.sahl = SAHL_VERSION;
    environment.device = info.name;
    environment.platform = info.platform;
    environment.device_version = info.version;
    environment.driver = info.driver;
    environment.threads = info.compute_units;
    environment.cpu = processor_name();
    const std::string kernels = expand_files(wavefront_sources(device.traversal())).text +
                                expand_files(incoherent_sources(device.incoherent_traversal())).text;
    environment.kernel_hash = fmt::format("{:016x}", fnv1a(device.build_options(), fnv1a(kernels)));
}

}  // namespace sahl
