// The OpenCL handles behind the public classes of engine/device.
#pragma once

#include <string>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/device.h"
#include "engine/device/launch_record.h"
#include "engine/device/opencl.h"

namespace sahl {

/// A launch that has been queued and whose times are not read yet.
struct PendingLaunch {
    std::string kernel;
    std::uint32_t generation;
    std::uint64_t items;
    std::uint64_t lanes;
    cl::Event event;
};

struct LaunchLog::Impl {
    bool enabled = false;
    std::vector<PendingLaunch> pending;
};

struct Device::Impl {
    DeviceInfo info;
    std::string platform_version;
    std::size_t local_size = 1;
    std::uint32_t rays_per_item = 1;
    Traversal traversal = Traversal::scalar;
    Traversal incoherent_traversal = Traversal::scalar;
    std::string build_options;
    bool compiles_beside = false;
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;
    MemoryAccountant memory;
    LaunchLog launches;
};

struct Buffer::Impl {
    Device& device;
    std::string name;
    std::size_t bytes;
    MemoryReservation driver_memory;  ///< HostMemory accounts for itself
    HostMemory memory;                ///< behind `buffer` on zero-copy devices; empty elsewhere
    cl::Buffer buffer;

    ~Impl();
};

}  // namespace sahl
