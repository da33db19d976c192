// OpenCL devices: which there are, choosing one, and the queue its kernels run on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/device/launch_record.h"
#include "engine/device/memory.h"

namespace sahl {

struct DeviceInfo {
    int index = 0;  ///< as printed by `sahl devices` and taken by --device
    std::string name;
    std::string platform;
    std::string vendor;
    std::string version;  ///< CL_DEVICE_VERSION
    std::string driver;   ///< CL_DRIVER_VERSION
    bool is_cpu = false;
    bool is_pocl = false;
    int compute_units = 0;
    std::size_t global_memory = 0;   ///< bytes, as the driver says
    std::size_t max_allocation = 0;  ///< bytes of one buffer
};

/// Ways of rays through the tree (kernels/traverse_*.h).
enum class Traversal : std::uint8_t {
    scalar,  ///< ray by ray: any device
    packet,  ///< neighbours together, on CPUs: rays that go much the same way
    stream,  ///< single rays in turn, on CPUs: rays that go any way
};

/// How long a compiler may take.
enum class Compilation : std::uint8_t {
    optimized,
    /// For what is done before optimized kernels would be compiled: those if the program cache has them,
    /// else, with PoCL, kernels that are not optimized: compiled in half the time, they take four to eight
    /// times as long, to the same bits.
    quick,
};

/// As in the kernels' names.
const char* name_of(Traversal traversal);

struct DeviceOptions {
    std::string selector;  ///< empty: PoCL's CPU; digits: an index; else part of a name
    int threads = 0;  ///< CPU threads of PoCL; 0: all. Counts before the process's first OpenCL call only
    std::size_t work_group_size = 0;  ///< work-items; 0: the device's best. No image depends on it
    /// Nothing: on CPUs by batch, packets for rays that keep together and streams for others; ray by ray
    /// elsewhere. No image depends on it.
    std::optional<Traversal> traversal{};
    /// More options for the OpenCL compiler: -DSAHL_PLAIN_OPENCL for kernels without the host's SIMD
    /// builtins, -DSAHL_NO_AVX512 for those of AVX2 at most. No image depends on them.
    std::string build_options{};
    /// Whether /proc/self/exe takes compile orders (compile_helper.h): then the first compilation of kernels
    /// is shared with another process where there is a processor for it.
    bool takes_compile_orders = false;
};

/// All OpenCL devices in platform order.
/// Throws Error(device) with the package to install when there is no platform or no device.
std::vector<DeviceInfo> list_devices(int threads = 0);

/// An opened device: context, in-order profiling queue, memory accountant and launch records.
/// Not copyable, not movable: buffers and kernels refer to it.
class Device {
public:
    /// Throws Error(device) when nothing matches, or when several do (it lists them).
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    /// Buffers live in our own memory and mapping copies nothing.
    bool zero_copy() const;
    /// Work-items of a work-group: one for each launch of this device, so that PoCL compiles
    /// each kernel once.
    std::size_t local_size() const;
    /// Rays that one work-item handles one after the other (SAHL_RAYS_PER_ITEM in the kernels).
    std::uint32_t rays_per_item() const;

    /// The way that rays take through the tree.
    Traversal traversal() const;
    /// That of batches whose neighbours do not keep together.
    Traversal incoherent_traversal() const;

    /// DeviceOptions::build_options.
    const std::string& build_options() const;

    /// Whether a CompileHelper can be started and has a processor.
    bool compiles_beside() const;

    /// Most work-items of one launch. PoCL compiles a kernel once more for grids beyond it.
    std::size_t max_work_items() const;

    MemoryAccountant& memory();
    LaunchLog& launches();

    /// Hands queued commands to the driver without waiting.
    void flush();
    /// Waits until all queued commands have run.
    void finish();

    struct Impl;  ///< the OpenCL handles, for engine/device alone
    Impl& impl();

private:
    std::unique_ptr<Impl> impl_;
};

/// Kernels that PoCL has compiled in this process: files in its private folder that no program cache put
/// there. Those of other drivers are not known.
std::size_t count_compilations();

/// Whether the disk of the folder that PoCL compiles into is full, or the folder is gone: why it aborts.
/// Async-signal-safe.
bool driver_lacks_room();

/// Ends the process with `status` at once, whatever its threads do, and removes what OpenCL drivers
/// keep in temporary files for it. For a process that is interrupted: nothing is destroyed in order.
/// Async-signal-safe.
[[noreturn]] void exit_at_once(int status);

}  // namespace sahl
