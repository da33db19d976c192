// Kernels: from the embedded sources to named launches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/device.h"

namespace sahl {

class Program;

/// One launch: how many work-items, and what its record says.
struct Launch {
    std::size_t work_items =
        0;  ///< rounded up to whole work-groups; at most Device::max_work_items(); 0: no launch
    std::uint32_t generation = 0;
    std::uint64_t items = 0;                ///< rays or slots worked on, for the record
    std::uint32_t items_per_work_item = 1;  ///< that a work-item has room for, for the record
};

/// A kernel of a program. Arguments are buffers or trivially copyable values (shared structs,
/// 32-bit scalars) in the order of the kernel's parameters. Keeps its program alive.
class Kernel {
public:
    ~Kernel();
    Kernel(Kernel&&) noexcept;

    template <class... Args>
    void launch(const Launch& launch, const Args&... args) {
        std::uint32_t index = 0;
        (set_argument(index++, args), ...);
        enqueue(launch, index);
    }

    struct Impl;

private:
    friend class Program;
    explicit Kernel(std::unique_ptr<Impl> impl);

    template <class T>
    void set_argument(std::uint32_t index, const T& value) {
        if constexpr (std::is_same_v<T, Buffer>) {
            set_buffer(index, value);
        } else {
            static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
            set_value(index, &value, sizeof(T));
        }
    }
    void set_buffer(std::uint32_t index, const Buffer& buffer);
    void set_value(std::uint32_t index, const void* value, std::size_t bytes);
    /// Throws Error(internal) when `argument_count` is not the kernel's or the items are too many.
    void enqueue(const Launch& launch, std::uint32_t argument_count);

    std::unique_ptr<Impl> impl_;
};

/// A built OpenCL program: files of kernels/ one after the other, includes expanded. The kernels
/// see SAHL_RAYS_PER_ITEM, the device's rays_per_item().
/// Binaries come from and go to the program cache (program_cache.h).
class Program {
public:
    /// `sources`: file names below kernels/, e.g. {"generate.cl", "shade.cl"}.
    /// `options`: further compiler options, e.g. "-DNAME=1".
    /// `beside`: kernels that a CompileHelper may compile, if the device has one; they are waited
    /// for at their first launch. Throws Error(device) with device, options, log and the source lines the log
    /// speaks of.
    Program(Device& device, const std::vector<std::string>& sources, const std::string& options = "",
            Compilation compilation = Compilation::optimized, const std::set<std::string>& beside = {});
    /// The same from a source text (with includes of kernels/ files), for tests.
    static Program from_text(Device& device, const std::string& text, const std::string& options = "");
    ~Program();
    Program(Program&&) noexcept;

    /// Throws Error(internal) when there is no such kernel.
    Kernel kernel(const std::string& name);

    /// Puts the binary into the program cache if kernels were compiled that are not in it yet, and
    /// waits for the queue then. PoCL compiles a kernel at its first launch: call this after the
    /// first frame. The end of the program and its kernels does it too.
    void store_binary();

    /// What PoCL has compiled so far, packed (pocl_programs.h); nothing of other drivers. Waits for the
    /// queue.
    std::optional<std::string> compiled_files();

    /// Whether the program came from the cache.
    bool from_cache() const;

    /// Whether its kernels are optimized, as they may not be if quick ones were asked for.
    bool is_optimized() const;

    /// Whether its kernels, compiled as they are here, have passed the self-test: in this process or, as
    /// the program cache says, in an earlier one.
    bool passed_self_test() const;
    /// Puts it on record that they have, here and, with the binary, in the program cache. Waits for the
    /// queue.
    void record_self_test();

    struct Impl;

private:
    explicit Program(std::shared_ptr<Impl> impl);
    std::shared_ptr<Impl> impl_;
};

}  // namespace sahl
