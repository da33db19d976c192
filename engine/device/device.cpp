#include "engine/device/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <thread>

#include "engine/core/error.h"
#include "engine/device/device_choice.h"
#include "engine/device/device_impl.h"
#include "engine/device/pocl_environment.h"
#include "engine/device/pocl_programs.h"

namespace sahl {
namespace {

// PoCL runs heavy work-items in groups of one best; a GPU wants one ray an item and full warps.
constexpr std::size_t cpu_local_size = 1;
constexpr std::uint32_t cpu_rays_per_item = 64;
constexpr std::size_t gpu_local_size = 64;
constexpr std::uint32_t gpu_rays_per_item = 1;

// PoCL 3.1 compiles one variant of a kernel for up to this many work-items and another one beyond.
constexpr std::size_t pocl_small_grid = 65534;

constexpr const char* install_hint =
    "install PoCL, which runs kernels on the CPU (Debian: apt-get install pocl-opencl-icd), or the OpenCL "
    "driver "
    "of your GPU";

struct FoundDevice {
    cl::Device device;
    DeviceInfo info;
    std::string platform_version;
};

/// Drivers end some of their strings with blanks or a zero.
std::string trimmed(std::string text) {
    const std::size_t end = text.find_last_not_of(std::string_view(" \0", 2));
    text.erase(end == std::string::npos ? 0 : end + 1);
    text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
    return text;
}

template <cl_device_info what>
auto device_info(const cl::Device& device) {
    cl_int status = CL_SUCCESS;
    auto value = device.getInfo<what>(&status);
    check_cl(status, "asking an OpenCL device for its properties");
    return value;
}

DeviceInfo describe(const cl::Device& device, const cl::Platform& platform, int index) {
    DeviceInfo info;
    info.index = index;
    info.name = trimmed(device_info<CL_DEVICE_NAME>(device));
    info.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    info.vendor = trimmed(device_info<CL_DEVICE_VENDOR>(device));
    info.version = trimmed(device_info<CL_DEVICE_VERSION>(device));
    info.driver = trimmed(device_info<CL_DRIVER_VERSION>(device));
    info.is_cpu = (device_info<CL_DEVICE_TYPE>(device) & CL_DEVICE_TYPE_CPU) != 0;
    info.is_pocl = info.platform == "Portable Computing Language";
    info.compute_units = static_cast<int>(device_info<CL_DEVICE_MAX_COMPUTE_UNITS>(device));
    info.global_memory = device_info<CL_DEVICE_GLOBAL_MEM_SIZE>(device);
    info.max_allocation = device_info<CL_DEVICE_MAX_MEM_ALLOC_SIZE>(device);
    return info;
}

std::vector<FoundDevice> find_devices(int threads) {
    prepare_pocl(threads);
    std::vector<cl::Platform> platforms;
    const cl_int status = cl::Platform::get(&platforms);
    if (status != CL_SUCCESS || platforms.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("no OpenCL platform found ({}): {}", cl_error_name(status), install_hint));
    }
    std::vector<FoundDevice> found;
    std::string without;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> devices;
        // A driver whose hardware is missing answers with an error: others may still serve.
        const cl_int answer = platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        if (answer != CL_SUCCESS) {
            without += fmt::format("\n  {}: {}", trimmed(platform.getInfo<CL_PLATFORM_NAME>()),
                                   cl_error_name(answer));
            continue;
        }
        for (const cl::Device& device : devices) {
            found.push_back({device, describe(device, platform, static_cast<int>(found.size())),
                             trimmed(platform.getInfo<CL_PLATFORM_VERSION>())});
        }
    }
    if (found.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("no OpenCL device found: {}; the platforms say:{}", install_hint, without));
    }
    return found;
}

std::vector<DeviceInfo> infos(const std::vector<FoundDevice>& devices) {
    std::vector<DeviceInfo> result;
    result.reserve(devices.size());
    for (const FoundDevice& device : devices) result.push_back(device.info);
    return result;
}

void check_usable(const FoundDevice& found) {
    const auto refuse = [&](const std::string& reason) {
        throw Error(ExitCode::device,
                    fmt::format("device {}: {}; choose another with --device", found.info.name, reason));
    };
    if (!device_info<CL_DEVICE_AVAILABLE>(found.device)) refuse("the driver says that it is not available");
    if (!device_info<CL_DEVICE_COMPILER_AVAILABLE>(found.device)) refuse("its driver has no compiler");
    // "OpenCL 1.2 ...": the first version with what the kernels use.
    if (found.info.version < "OpenCL 1.2")
        refuse("it offers " + found.info.version + ", Sahl needs OpenCL 1.2");
}

}  // namespace

const char* name_of(Traversal traversal) {
    switch (traversal) {
        case Traversal::scalar:
            return "scalar";
        case Traversal::packet:
            return "packet";
        case Traversal::stream:
            return "stream";
    }
    throw Error(ExitCode::internal, "a traversal without a name");
}

std::vector<DeviceInfo> list_devices(int threads) { return infos(find_devices(threads)); }

Device::Device(const DeviceOptions& options) : impl_(std::make_unique<Impl>()) {
    const std::vector<FoundDevice> devices = find_devices(options.threads);
    const FoundDevice& chosen = devices[choose_device(infos(devices), options.selector)];
    check_usable(chosen);
    impl_->info = chosen.info;
    impl_->platform_version = chosen.platform_version;
    impl_->device = chosen.device;
    const std::size_t largest_group = device_info<CL_DEVICE_MAX_WORK_GROUP_SIZE>(chosen.device);
    const std::size_t best_group = chosen.info.is_cpu ? cpu_local_size : gpu_local_size;
    impl_->local_size =
        std::min(options.work_group_size > 0 ? options.work_group_size : best_group, largest_group);
    const bool is_cpu = chosen.info.is_cpu;
    impl_->traversal = options.traversal.value_or(is_cpu ? Traversal::packet : Traversal::scalar);
    impl_->incoherent_traversal = options.traversal.value_or(is_cpu ? Traversal::stream : Traversal::scalar);
    impl_->build_options = options.build_options;
    impl_->compiles_beside =
        options.takes_compile_orders && options.threads != 1 && std::thread::hardware_concurrency() > 1;
    impl_->rays_per_item = chosen.info.is_cpu ? cpu_rays_per_item : gpu_rays_per_item;
    cl_int status = CL_SUCCESS;
    impl_->context = cl::Context(impl_->device, nullptr, nullptr, nullptr, &status);
    check_cl(status, "opening device " + chosen.info.name);
    impl_->queue = cl::CommandQueue(impl_->context, impl_->device, CL_QUEUE_PROFILING_ENABLE, &status);
    check_cl(status, "making a command queue of device " + chosen.info.name);
}

Device::~Device() { impl_->queue.finish(); }

const DeviceInfo& Device::info() const { return impl_->info; }

bool Device::zero_copy() const { return impl_->info.is_cpu; }

std::size_t Device::local_size() const { return impl_->local_size; }

std::uint32_t Device::rays_per_item() const { return impl_->rays_per_item; }

Traversal Device::traversal() const { return impl_->traversal; }

Traversal Device::incoherent_traversal() const { return impl_->incoherent_traversal; }

const std::string& Device::build_options() const { return impl_->build_options; }

bool Device::compiles_beside() const { return impl_->compiles_beside; }

std::size_t Device::max_work_items() const { return impl_->info.is_pocl ? pocl_small_grid : SIZE_MAX; }

MemoryAccountant& Device::memory() { return impl_->memory; }

LaunchLog& Device::launches() { return impl_->launches; }

std::size_t count_compilations() { return count_compiled_kernels() - count_unpacked_kernels(); }

void Device::flush() { check_cl(impl_->queue.flush(), "handing commands to device " + impl_->info.name); }

void Device::finish() { check_cl(impl_->queue.finish(), "waiting for device " + impl_->info.name); }

Device::Impl& Device::impl() { return *impl_; }

}  // namespace sahl
