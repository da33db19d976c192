#include "engine/profile/calibrate.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/hash.h"
#include "engine/device/program.h"
#include "engine/device/program_cache.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

/// Of each kernel, short ones: the fastest counts, which no other process has held up.
constexpr int runs = 40;
constexpr std::size_t floats_of_vector = 16;
constexpr std::uint32_t items_per_unit = 16;

/// What was measured would be another on another device, driver or number of threads.
fs::path cache_file(const Device& device) {
    const DeviceInfo& info = device.info();
    const std::optional<fs::path> folder = cache_folder();
    if (!folder) return {};
    const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}", info.platform, info.name, info.version,
                                        info.driver, info.compute_units);
    return *folder / fmt::format("{:016x}.sahl-calibration", fnv1a(key));
}

std::optional<Calibration> load(const fs::path& path) {
    std::ifstream file(path);
    if (!file) return std::nullopt;
    const auto json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    const Calibration calibration{json.value("bandwidth_gb_per_s", 0.0), json.value("fma_gflop_per_s", 0.0),
                                  true};
    if (!(calibration.bandwidth_gb_per_s > 0 && calibration.fma_gflop_per_s > 0)) return std::nullopt;
    return calibration;
}

void store(const fs::path& path, const Calibration& calibration) {
    const nlohmann::json json{{"bandwidth_gb_per_s", calibration.bandwidth_gb_per_s},
                              {"fma_gflop_per_s", calibration.fma_gflop_per_s}};
    const std::string text = json.dump() + '\n';
    try {
        write_file(path, std::as_bytes(std::span(text)));
    } catch (const Error&) {
        // It is measured again in the next run.
    }
}

/// Seconds of the fastest of several launches, after one that may compile.
template <class... Arguments>
double fastest(Device& device, Kernel kernel, const Launch& launch, const Arguments&... arguments) {
    kernel.launch(launch, arguments...);
    device.finish();
    device.launches().take();
    device.launches().enable(true);
    for (int run = 0; run < runs; ++run) kernel.launch(launch, arguments...);
    std::uint64_t least = UINT64_MAX;
    for (const LaunchRecord& record : device.launches().take()) {
        least = std::min(least, record.ended_ns - record.started_ns);
    }
    device.launches().enable(false);
    return static_cast<double>(std::max<std::uint64_t>(least, 1)) * 1e-9;
}

std::uint32_t work_items(const Device& device) {
    const auto units = static_cast<std::uint32_t>(std::max(device.info().compute_units, 1));
    if (device.info().is_cpu) return units * items_per_unit;
    return units * items_per_unit * 256;  // what hides a GPU's latencies
}

double measure_bandwidth(Device& device, Program& program) {
    const std::size_t wanted = 4 * last_level_cache_bytes();
    const std::size_t room =
        device.memory().limit() - std::min(device.memory().limit(), device.memory().current());
    const std::size_t bytes = std::min({wanted, device.info().max_allocation, room / 4});
    const auto vectors = static_cast<std::uint32_t>(bytes / sizeof(float) / floats_of_vector);
    const std::size_t floats = std::size_t{vectors} * floats_of_vector;
    Buffer a(device, floats * sizeof(float), "triad a");
    Buffer b(device, floats * sizeof(float), "triad b");
    Buffer c(device, floats * sizeof(float), "triad c");
    std::minstd_rand random;
    for (Buffer* buffer : {&b, &c}) {  // not zeros, which memory may compress
        const auto values = buffer->map<std::uint32_t>(MapMode::write, floats);
        for (std::uint32_t& value : values) {
            value = 0x3f800000U | (static_cast<std::uint32_t>(random()) & 0x7fffffU);  // 1..2
        }
    }
    const std::uint32_t items = work_items(device);
    const std::uint32_t per_item = (vectors + items - 1) / items;
    const double seconds =
        fastest(device, program.kernel("triad"), {.work_items = items}, a, b, c, 0.5F, vectors, per_item);
    return 3 * static_cast<double>(floats * sizeof(float)) / seconds * 1e-9;
}

double measure_peak(Device& device, Program& program) {
    const std::uint32_t items = work_items(device);
    Buffer out(device, (items + device.local_size()) * floats_of_vector * sizeof(float), "multiply-add");
    program.kernel("flop_of_round").launch({.work_items = 1}, out);
    const std::uint32_t flop = out.map<std::uint32_t>(MapMode::read, 1)[0];
    const std::uint32_t rounds = device.info().is_cpu ? 10'000 : 2'000;
    const double seconds =
        fastest(device, program.kernel("multiply_add"), {.work_items = items}, out, 0.999F, 0.001F, rounds);
    return static_cast<double>(flop) * rounds * items / seconds * 1e-9;
}

}  // namespace

std::size_t last_level_cache_bytes() {
    std::size_t largest = 0;
    for (int index = 0;; ++index) {
        std::ifstream file(fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/size", index));
        std::size_t kibibytes = 0;
        if (!(file >> kibibytes)) break;
        largest = std::max(largest, kibibytes << 10U);
    }
    return largest > 0 ? largest : std::size_t{32} << 20U;
}

Calibration calibrate(Device& device) {
    const fs::path path = cache_file(device);
    if (const auto cached = load(path)) return *cached;
    Program program(device, {"calibrate.cl"});
    const Calibration calibration{measure_bandwidth(device, program), measure_peak(device, program), false};
    if (!path.empty()) store(path, calibration);
    return calibration;
}

}  // namespace sahl
