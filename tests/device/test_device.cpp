#include <signal.h>  // NOLINT: kill
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <iostream>

#include "engine/device/device.h"
#include "engine/device/device_choice.h"
#include "engine/device/pocl_environment.h"
#include "engine/device/program.h"
#include "tests/device/test_device_support.h"
#include "tests/support/run_process.h"

namespace sahl::tests {
namespace {

DeviceInfo device_named(int index, const std::string& name, bool is_cpu, bool is_pocl) {
    DeviceInfo info;
    info.index = index;
    info.name = name;
    info.platform = is_pocl ? "Portable Computing Language" : "Acme Compute";
    info.is_cpu = is_cpu;
    info.is_pocl = is_pocl;
    return info;
}

const std::vector<DeviceInfo> machine = {
    device_named(0, "Acme RTX 90", false, false),
    device_named(1, "Acme RTX 90 Super", false, false),
    device_named(2, "Acme Xeon", true, false),
    device_named(3, "pthread-haswell", true, true),
};

/// Runs one of the hidden test cases below in a process of its own.
ProcessResult probe(const std::string& name, std::map<std::string, std::optional<std::string>> environment) {
    ProcessOptions options;
    options.environment = std::move(environment);
    return run_process({std::filesystem::read_symlink("/proc/self/exe").string(), name}, options);
}

std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace

TEST_CASE("device choice: the default is PoCL's CPU, else a CPU, else the first") {
    CHECK(choose_device(machine, "") == 3);
    CHECK(choose_device(std::span(machine).first(3), "") == 2);
    CHECK(choose_device(std::span(machine).first(2), "") == 0);
}

TEST_CASE("device choice: by index and by name") {
    CHECK(choose_device(machine, "0") == 0);
    CHECK(choose_device(machine, "02") == 2);
    CHECK(choose_device(machine, "xeon") == 2);
    CHECK(choose_device(machine, "HASWELL") == 3);
    CHECK(choose_device(machine, "portable computing") == 3);
    CHECK(choose_device(machine, "rtx 90 s") == 1);
    CHECK(choose_device(machine, "acme rtx 90") == 0);  // a whole name, though also a part of another
}

TEST_CASE("device choice: several matches are listed, and only they") {
    const std::string message = error_of(ExitCode::device, [] { choose_device(machine, "rtx"); });
    CHECK(contains(message, "--device rtx"));
    CHECK(contains(message, "0: Acme RTX 90 (Acme Compute)"));
    CHECK(contains(message, "1: Acme RTX 90 Super (Acme Compute)"));
    CHECK_FALSE(contains(message, "Xeon"));
}

TEST_CASE("device choice: no match lists all devices") {
    const std::string selector = GENERATE("4", "99999999999999999999999", "radeon", "-1");
    const std::string message = error_of(ExitCode::device, [&] { choose_device(machine, selector); });
    CHECK(contains(message, "--device " + selector));
    for (const DeviceInfo& device : machine) CHECK(contains(message, device.name));
}

TEST_CASE("a device says what it is") {
    const std::vector<DeviceInfo> devices = list_devices();
    REQUIRE_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        CHECK(devices[i].index == static_cast<int>(i));
        CHECK_FALSE(devices[i].name.empty());
        CHECK(devices[i].compute_units > 0);
        CHECK(devices[i].max_allocation > 0);
        CHECK(devices[i].max_allocation <= devices[i].global_memory);
    }
    Device device;
    CHECK(device.zero_copy() == device.info().is_cpu);
    CHECK(device.rays_per_item() == (device.info().is_cpu ? 64 : 1));
    CHECK(device.memory().current() == 0);
    CHECK(Device({std::to_string(device.info().index), 0}).info().name == device.info().name);
    CHECK(Device({device.info().name, 0}).info().name == device.info().name);
    CHECK(contains(error_of(ExitCode::device, [] { Device({"no such device", 0}); }), device.info().name));
}

TEST_CASE("probe: device", "[.probe]") {
    const char* threads = getenv("SAHL_PROBE_THREADS");
    std::string message;
    try {
        Device device({"", threads != nullptr ? std::atoi(threads) : 0});
        Program program =
            Program::from_text(device, "__kernel void set(__global int* out) { out[get_global_id(0)] = 1; }");
        Buffer out(device, 4, "out");
        program.kernel("set").launch({.work_items = 1}, out);
        device.finish();
        message = "units=" + std::to_string(device.info().compute_units) +
                  " compiled=" + std::to_string(count_compiled_kernels());
    } catch (const Error& error) {
        message = "code=" + std::to_string(static_cast<int>(error.code())) + " " + error.what();
    }
    const char* folder = getenv("POCL_CACHE_DIR");
    struct stat status = {};
    if (folder != nullptr && stat(folder, &status) == 0) {
        message += " folder=" + std::string(folder) + " mode=" + std::to_string(status.st_mode & 0777);
    }
    std::cout << "probe: " << message << std::endl;
    if (getenv("SAHL_PROBE_DIE") != nullptr) kill(getpid(), SIGKILL);
    CHECK(folder != nullptr);
}

TEST_CASE("threads: PoCL gets as many as asked for") {
    const std::string threads = GENERATE("1", "3");
    const ProcessResult result = probe("probe: device", {{"SAHL_PROBE_THREADS", threads}});
    CHECK(result.status == 0);
    CHECK(contains(result.out, "units=" + threads + " "));
}

TEST_CASE("PoCL compiles into a folder of the process, without HOME, and it goes at exit") {
    const TemporaryFolder parent;
    const ProcessResult result = probe("probe: device", {{"TMPDIR", parent.path().string()},
                                                         {"HOME", std::nullopt},
                                                         {"XDG_CACHE_HOME", std::nullopt},
                                                         {"SAHL_CACHE_DIR", std::nullopt},
                                                         {"POCL_CACHE_DIR", "/nonexistent"}});
    CHECK(result.status == 0);
    CHECK(contains(result.out, "compiled=1 "));
    CHECK(contains(result.out, "folder=" + parent.path().string() + "/sahl-pocl-"));
    CHECK(contains(result.out, "mode=" + std::to_string(0700)));
    CHECK(entries(parent.path()) == 0);
}

TEST_CASE("folders of killed processes go, those of living ones and strangers' stay") {
    const TemporaryFolder parent;
    const std::map<std::string, std::optional<std::string>> here = {{"TMPDIR", parent.path().string()}};
    auto killed = here;
    killed["SAHL_PROBE_DIE"] = "1";
    CHECK(probe("probe: device", killed).status == 128 + SIGKILL);
    CHECK(entries(parent.path()) == 1);
    std::filesystem::create_directory(parent.path() / "somebody-elses");
    std::filesystem::create_directory_symlink(parent.path() / "somebody-elses",
                                              parent.path() / "sahl-pocl-1-link");
    write_file(parent.path() / "somebody-elses" / "lock", "");
    CHECK(probe("probe: device", here).status == 0);
    CHECK(entries(parent.path()) == 2);
    CHECK(std::filesystem::exists(parent.path() / "somebody-elses" / "lock"));

    list_devices();  // this process has its folder now, and the others leave it alone
    const std::string own = getenv("POCL_CACHE_DIR");
    CHECK(probe("probe: device", {}).status == 0);
    CHECK(std::filesystem::exists(own));
}

TEST_CASE("no OpenCL platform: the message names the package to install") {
    const ProcessResult result = probe("probe: device", {{"OCL_ICD_VENDORS", "/nonexistent"}});
    CHECK(contains(result.out, "code=4 "));
    CHECK(contains(result.out, "apt-get install pocl-opencl-icd"));
}

TEST_CASE("a temporary folder that cannot be used is refused before PoCL aborts") {
    const std::string folder = GENERATE("/nonexistent", "/proc", "/dev/null");
    const ProcessResult result = probe("probe: device", {{"TMPDIR", folder}});
    CHECK(contains(result.out, "code=4 " + folder));
    CHECK(contains(result.out, "set TMPDIR"));
}

}  // namespace sahl::tests
