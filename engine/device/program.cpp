#include "engine/device/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "engine/core/host_steps.h"
#include "engine/core/log.h"
#include "engine/device/compile_helper.h"
#include "engine/device/device_impl.h"
#include "engine/device/kernel_source.h"
#include "engine/device/pocl_environment.h"
#include "engine/device/pocl_programs.h"
#include "engine/device/program_cache.h"

namespace sahl {

struct Program::Impl {
    Device& device;
    std::string key;  ///< in the program cache
    cl::Program program{};
    bool optimized = true;
    bool from_cache = false;
    std::set<std::string> cached{};    ///< kernels whose compiled code is in the cache
    std::set<std::string> launched{};  ///< kernels that have been compiled for this device
    bool tested = false;               ///< has passed the self-test
    bool cached_tested = false;        ///< and the cache says so
    std::unique_ptr<CompileHelper> helper{};
    std::set<std::string> beside{};  ///< kernels that it compiles

    ~Impl() { store(); }
    void store() noexcept;
    void before_first_launch(const std::string& kernel);
};

struct Kernel::Impl {
    std::shared_ptr<Program::Impl> program;
    std::string name;
    cl::Kernel kernel;
    std::uint32_t arguments;
    bool launched = false;
};

namespace {

/// Keys of the programs that have passed the self-test in this process: all that is known of them where
/// there is no cache.
class PassedPrograms {
public:
    bool contains(const std::string& key) {
        const std::lock_guard lock(mutex_);
        return keys_.contains(key);
    }
    void insert(const std::string& key) {
        const std::lock_guard lock(mutex_);
        keys_.insert(key);
    }

private:
    std::mutex mutex_;
    std::set<std::string> keys_;
};

PassedPrograms& passed_programs() {
    static PassedPrograms programs;
    return programs;
}

/// "model name" and "flags" of the first processor: what a compiler for the host looks at.
std::string cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    std::string model;
    for (std::string line; std::getline(file, line) && !line.empty();) {
        if (line.rfind("model name", 0) == 0 || line.rfind("flags", 0) == 0) model += line + '\n';
    }
    return model;
}

/// Of Compilation::quick, behind all others.
constexpr const char* quick_option = "-cl-opt-disable";

std::string cache_key(Device& device, const KernelSource& source, const std::string& options) {
    const DeviceInfo& info = device.info();
    return fmt::format(
        "options {}\nlocal size {}\ndevice {}\nvendor {}\nversion {}\ndriver {}\nplatform {}, {}\n{}\n{}",
        options, device.local_size(), info.name, info.vendor, info.version, info.driver, info.platform,
        device.impl().platform_version, info.is_cpu ? cpu_model() : "", source.text);
}

/// The program from a cached binary; nothing if the driver does not take it.
cl::Program build_from_binary(Device& device, const std::string& binary, const std::string& options) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
    const cl::Program::Binaries binaries{{bytes, bytes + binary.size()}};
    cl_int status = CL_SUCCESS;
    cl::Program program(device.impl().context, {device.impl().device}, binaries, nullptr, &status);
    if (status != CL_SUCCESS || program.build({device.impl().device}, options.c_str()) != CL_SUCCESS)
        return {};
    return program;
}

cl::Program build_from_source(Device& device, const KernelSource& source, const std::string& options) {
    cl_int status = CL_SUCCESS;
    cl::Program program(device.impl().context, source.text, false, &status);
    check_cl(status, "creating a program");
    status = program.build({device.impl().device}, options.c_str());
    if (status == CL_SUCCESS) return program;
    if (driver_lacks_room()) {
        throw Error(ExitCode::device,
                    fmt::format("building the kernels failed, for there is no room in {}; free some space or "
                                "set TMPDIR to another folder",
                                pocl_folder().string()));
    }
    const std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.impl().device);
    throw Error(ExitCode::device,
                fmt::format("building the kernels failed: {}\ndevice: {} ({}, driver {})\noptions: {}\n{}",
                            cl_error_name(status), device.info().name, device.info().platform,
                            device.info().driver, options, annotate_build_log(log, source)));
}

std::shared_ptr<Program::Impl> build(Device& device, const KernelSource& source, const std::string& more,
                                     Compilation compilation = Compilation::optimized,
                                     const std::set<std::string>& beside = {}) {
    const HostStep step("compile");
    // Without warnings, whose number PoCL prints: wide vectors make hundreds on a processor that lacks them.
    std::string options = fmt::format("-cl-std=CL1.2 -w -DSAHL_RAYS_PER_ITEM={}", device.rays_per_item());
    for (const std::string& option : {device.build_options(), more}) {
        if (!option.empty()) options += " " + option;
    }
    std::shared_ptr<Program::Impl> impl(new Program::Impl{device, cache_key(device, source, options)});
    std::optional<CachedProgram> cached = load_program(impl->key);
    if (compilation == Compilation::quick && !cached && device.info().is_pocl) {
        options += fmt::format(" {}", quick_option);
        impl->optimized = false;
        impl->key = cache_key(device, source, options);
        cached = load_program(impl->key);
    }
    const auto from_source = [&] { impl->program = build_from_source(device, source, options); };
    if (device.info().is_pocl) {
        const bool unpacked = cached && unpack_compiled(impl->key, cached->binary);
        const bool compiled = build_watched(impl->key, from_source);
        impl->from_cache = unpacked && !compiled;
        if (compiled && !beside.empty() && device.compiles_beside()) {
            std::string of_helper = device.build_options();
            if (!impl->optimized)
                of_helper += fmt::format("{}{}", of_helper.empty() ? "" : " ", quick_option);
            impl->helper =
                CompileHelper::start(device, of_helper, impl->key, pack_compiled(impl->key).value_or(""));
            impl->beside = beside;
        }
    } else {
        if (cached) impl->program = build_from_binary(device, cached->binary, options);
        impl->from_cache = impl->program() != nullptr;
        if (!impl->from_cache) from_source();
    }
    if (impl->from_cache) {
        impl->cached.insert(cached->kernels.begin(), cached->kernels.end());
        impl->cached_tested = cached->tested;
    }
    impl->tested = impl->cached_tested || passed_programs().contains(impl->key);
    return impl;
}

/// The driver's binary; nothing if it has none.
std::optional<std::string> driver_binary(const cl::Program& program) {
    cl_int status = CL_SUCCESS;
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>(&status);
    if (status != CL_SUCCESS || binaries.size() != 1 || binaries[0].empty()) return std::nullopt;
    return std::string(binaries[0].begin(), binaries[0].end());
}

}  // namespace

void Program::Impl::store() noexcept try {
    const bool is_pocl = device.info().is_pocl;
    // A binary of another driver holds all kernels from the start.
    const bool complete = (from_cache && !is_pocl) ||
                          std::includes(cached.begin(), cached.end(), launched.begin(), launched.end());
    if (complete && tested == cached_tested) return;
    device.impl().queue.finish();  // PoCL compiles until then
    const std::optional<std::string> binary = is_pocl ? pack_compiled(key) : driver_binary(program);
    if (!binary) return;
    cached.insert(launched.begin(), launched.end());
    store_program(key, {*binary, {cached.begin(), cached.end()}, tested});
    cached_tested = tested;
} catch (...) {
    // What is not cached is compiled again in the next run.
}

void Program::Impl::before_first_launch(const std::string& kernel) {
    if (!helper || !beside.contains(kernel)) return;
    // Where it has failed PoCL compiles them at their launch, as any other kernel.
    const std::size_t added = add_compiled(key, helper->take());
    helper.reset();
    log_debug(fmt::format("{} kernels were compiled by another process meanwhile", added));
}

Program::Program(Device& device, const std::vector<std::string>& sources, const std::string& options,
                 Compilation compilation, const std::set<std::string>& beside)
    : impl_(build(device, expand_files(sources), options, compilation, beside)) {}

Program::Program(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

Program Program::from_text(Device& device, const std::string& text, const std::string& options) {
    return Program(build(device, expand_text(text), options));
}

Program::~Program() = default;
Program::Program(Program&&) noexcept = default;

Kernel Program::kernel(const std::string& name) {
    cl_int status = CL_SUCCESS;
    cl::Kernel kernel(impl_->program, name.c_str(), &status);
    check_cl(status, "looking up kernel " + name, ExitCode::internal);
    cl_uint arguments = 0;
    check_cl(kernel.getInfo(CL_KERNEL_NUM_ARGS, &arguments), "counting the parameters of kernel " + name);
    return Kernel(std::unique_ptr<Kernel::Impl>(new Kernel::Impl{impl_, name, std::move(kernel), arguments}));
}

void Program::store_binary() { impl_->store(); }

std::optional<std::string> Program::compiled_files() {
    impl_->device.impl().queue.finish();
    return pack_compiled(impl_->key);
}

bool Program::from_cache() const { return impl_->from_cache; }

bool Program::is_optimized() const { return impl_->optimized; }

bool Program::passed_self_test() const { return impl_->tested; }

void Program::record_self_test() {
    impl_->tested = true;
    passed_programs().insert(impl_->key);
    impl_->store();
}

Kernel::Kernel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;

void Kernel::set_buffer(std::uint32_t index, const Buffer& buffer) {
    const cl_int status = impl_->kernel.setArg(index, buffer.impl()->buffer);
    if (status == CL_SUCCESS) return;
    check_cl(status,
             fmt::format("kernel {}: giving buffer {} as argument {}", impl_->name, buffer.name(), index),
             ExitCode::internal);
}

void Kernel::set_value(std::uint32_t index, const void* value, std::size_t bytes) {
    const cl_int status = impl_->kernel.setArg(index, bytes, value);
    if (status == CL_SUCCESS) return;
    check_cl(status, fmt::format("kernel {}: giving {} bytes as argument {}", impl_->name, bytes, index),
             ExitCode::internal);
}

void Kernel::enqueue(const Launch& launch, std::uint32_t argument_count) {
    Device& device = impl_->program->device;
    if (argument_count != impl_->arguments) {
        throw Error(ExitCode::internal, fmt::format("kernel {}: {} arguments for {} parameters", impl_->name,
                                                    argument_count, impl_->arguments));
    }
    if (launch.work_items == 0) return;
    const std::size_t local = device.local_size();
    const std::size_t global = (launch.work_items + local - 1) / local * local;
    if (global > device.max_work_items()) {
        throw Error(ExitCode::internal,
                    fmt::format("kernel {}: {} work-items in one launch, {} runs at most {}", impl_->name,
                                global, device.info().name, device.max_work_items()));
    }
    if (!impl_->launched) impl_->program->before_first_launch(impl_->name);
    LaunchLog::Impl& log = device.launches().impl();
    cl::Event event;
    const cl_int status =
        device.impl().queue.enqueueNDRangeKernel(impl_->kernel, cl::NullRange, cl::NDRange(global),
                                                 cl::NDRange(local), nullptr, log.enabled ? &event : nullptr);
    if (status != CL_SUCCESS) check_cl(status, "launching kernel " + impl_->name);
    if (log.enabled) {
        log.pending.push_back({impl_->name, launch.generation, launch.items,
                               std::uint64_t{global} * launch.items_per_work_item, std::move(event)});
    }
    if (!impl_->launched) {
        impl_->launched = true;
        impl_->program->launched.insert(impl_->name);
    }
}

}  // namespace sahl
