#include "engine/profile/environment.h"

#include <fstream>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/hash.h"
#include "engine/device/kernel_source.h"
#include "engine/render/camera_constants.h"
#include "engine/render/launches.h"
#include "engine/render/lower_scene.h"
#include "engine/render/place_instances.h"

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

std::string hexadecimal(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

/// Of values without padding.
template <class Values>
std::uint64_t hash_of(const Values& values, std::uint64_t hash) {
    const auto bytes = std::as_bytes(std::span(values));
    return fnv1a({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, hash);
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
    environment.kernel_hash =
        hexadecimal(fnv1a(device.build_options(), fnv1a(expand_files(wavefront_sources(device)).text)));
}

std::string scene_hash(const Scene& scene, std::size_t camera) {
    const LoweredScene lowered = lower_scene(scene);
    std::uint64_t hash = hash_of(lowered.primitives, fnv1a("sahl scene"));
    hash = hash_of(lowered.shape_data, hash);
    hash = hash_of(lowered.outlines, hash);
    hash = hash_of(lowered.materials, hash);
    hash = hash_of(lowered.textures, hash);
    hash = hash_of(lowered.lights, hash);
    for (const PlacedGroup& placed : place_instances(scene)) {
        hash = hash_of(std::span(&placed.world_from_group, 1), hash);
    }
    const device::CameraConstants constants = camera_constants(scene.cameras[camera], {1, 1});
    hash = hash_of(std::span(&constants, 1), hash);
    return hexadecimal(hash_of(std::span(&scene.background, 1), hash));
}

}  // namespace sahl
