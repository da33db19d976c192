// Says when a process got where, without a change to it: preloaded (LD_PRELOAD), it stands before main() and
// before calls that a render consists of, and writes what it saw to the file SAHL_PROBE at the end.
//
// Lines of the file, times in ns of CLOCK_MONOTONIC_RAW (which PoCL's events count in, too):
//   main TIME                                 the loader and all constructors are done
//   call NAME START END                       a call that is no part of another one
//   kernel NAME QUEUED SUBMITTED START END    a launch
//   rename TIME PATH                          a file is in its place
#include <CL/cl.h>
#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <vector>

namespace {

std::uint64_t now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC_RAW, &time);
    return std::uint64_t(time.tv_sec) * 1'000'000'000u + std::uint64_t(time.tv_nsec);
}

struct Launch {
    std::string kernel;
    cl_event event;
};

/// Never destroyed: calls come until the process is gone.
struct Log {
    std::string path;
    std::mutex mutex;
    std::string lines;
    std::vector<Launch> pending;
};

Log& probe_log() {
    static Log* const log = new Log;
    return *log;
}

void add_line(const std::string& line) {
    const std::lock_guard lock(probe_log().mutex);
    probe_log().lines += line + '\n';
}

/// What stands behind the function of the same name here.
template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

thread_local int calls_around = 0;

/// Calls what stands behind the function of that name and writes a line, unless it is part of another call.
template <class Function, class... Arguments>
auto timed(Function* /*declared*/, const char* name, Arguments... arguments) {
    ++calls_around;
    const std::uint64_t start = now();
    const auto result = next<Function>(name)(arguments...);
    const std::uint64_t end = now();
    if (--calls_around == 0) {
        add_line(std::string("call ") + name + ' ' + std::to_string(start) + ' ' + std::to_string(end));
    }
    return result;
}

/// Writes of the launches that are finished. Launches finish in their order.
void take_launches() {
    const std::lock_guard lock(probe_log().mutex);
    std::vector<Launch>& pending = probe_log().pending;
    std::size_t done = 0;
    for (; done < pending.size(); ++done) {
        std::array<cl_ulong, 4> times{};
        constexpr std::array<cl_profiling_info, 4> asked{
            CL_PROFILING_COMMAND_QUEUED, CL_PROFILING_COMMAND_SUBMIT, CL_PROFILING_COMMAND_START,
            CL_PROFILING_COMMAND_END};
        std::string line = "kernel " + pending[done].kernel;
        bool complete = true;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            complete = complete && clGetEventProfilingInfo(pending[done].event, asked[i], sizeof(cl_ulong),
                                                           &times[i], nullptr) == CL_SUCCESS;
            line += ' ' + std::to_string(times[i]);
        }
        if (!complete) break;
        clReleaseEvent(pending[done].event);
        probe_log().lines += line + '\n';
    }
    pending.erase(pending.begin(), pending.begin() + std::ptrdiff_t(done));
}

std::string kernel_name(cl_kernel kernel) {
    std::array<char, 128> name{};
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, name.size() - 1, name.data(), nullptr);
    return name.data();
}

int (*real_main)(int, char**, char**);

int timed_main(int argc, char** argv, char** environment) {
    add_line("main " + std::to_string(now()));
    return real_main(argc, argv, environment);
}

/// The processes that this one starts are not probed.
__attribute__((constructor)) void begin() {
    const char* path = std::getenv("SAHL_PROBE");
    if (path != nullptr) probe_log().path = path;
    unsetenv("SAHL_PROBE");
    unsetenv("LD_PRELOAD");
}

__attribute__((destructor)) void write_log() {
    std::FILE* file = std::fopen(probe_log().path.c_str(), "w");
    if (file == nullptr) return;
    std::fputs(probe_log().lines.c_str(), file);
    std::fclose(file);
}

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
    real_main = main;
    return next<decltype(__libc_start_main)>("__libc_start_main")(timed_main, argc, argv, init, fini,
                                                                  rtld_fini, stack_end);
}

int rename(const char* from, const char* to) noexcept {
    const int result = next<decltype(rename)>("rename")(from, to);
    add_line("rename " + std::to_string(now()) + ' ' + to);
    return result;
}

void* dlopen(const char* file, int mode) noexcept { return timed(dlopen, "dlopen", file, mode); }

cl_int clGetPlatformIDs(cl_uint count, cl_platform_id* platforms, cl_uint* found) {
    return timed(clGetPlatformIDs, "clGetPlatformIDs", count, platforms, found);
}

cl_int clGetDeviceIDs(cl_platform_id platform, cl_device_type type, cl_uint count, cl_device_id* devices,
                      cl_uint* found) {
    return timed(clGetDeviceIDs, "clGetDeviceIDs", platform, type, count, devices, found);
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device,
                                      cl_command_queue_properties properties, cl_int* status) {
    return timed(clCreateCommandQueue, "clCreateCommandQueue", context, device, properties, status);
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** texts,
                                     const std::size_t* lengths, cl_int* status) {
    return timed(clCreateProgramWithSource, "clCreateProgramWithSource", context, count, texts, lengths,
                 status);
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                      void (*notify)(cl_program, void*), void* data) {
    return timed(clBuildProgram, "clBuildProgram", program, count, devices, options, notify, data);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const std::size_t* offset, const std::size_t* global, const std::size_t* local,
                              cl_uint waits, const cl_event* wait_list, cl_event* event) {
    cl_event own = nullptr;
    const cl_int status = timed(clEnqueueNDRangeKernel, "clEnqueueNDRangeKernel", queue, kernel, dimensions,
                                offset, global, local, waits, wait_list, &own);
    if (status != CL_SUCCESS) return status;
    if (event != nullptr) {
        *event = own;
        clRetainEvent(own);
    }
    const std::string name = kernel_name(kernel);
    const std::lock_guard lock(probe_log().mutex);
    probe_log().pending.push_back({name, own});
    return status;
}

cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
    const cl_int status = timed(clWaitForEvents, "clWaitForEvents", count, events);
    take_launches();
    return status;
}

cl_int clFinish(cl_command_queue queue) {
    const cl_int status = timed(clFinish, "clFinish", queue);
    take_launches();
    return status;
}

}  // extern "C"
