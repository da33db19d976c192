// `sahl devices`: which OpenCL devices there are, and whether they compute rightly.
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/options.h"
#include "cli/standard_output.h"
#include "engine/device/device_choice.h"
#include "engine/self_test/self_test.h"

namespace sahl::cli {

namespace {

std::string mebibytes(std::size_t bytes) { return fmt::format("{} MiB", bytes >> 20U); }

std::string device_text(const DeviceInfo& device, bool chosen) {
    return fmt::format(
        "{} {:>2}  {}\n"
        "      platform {}, driver {}\n"
        "      {} compute units, {} memory, largest buffer {}\n",
        chosen ? '*' : ' ', device.index, device.name, device.platform, device.driver, device.compute_units,
        mebibytes(device.global_memory), mebibytes(device.max_allocation));
}

nlohmann::ordered_json device_event(const DeviceInfo& device, bool chosen) {
    return {{"event", "device"},
            {"index", device.index},
            {"name", device.name},
            {"platform", device.platform},
            {"vendor", device.vendor},
            {"version", device.version},
            {"driver", device.driver},
            {"cpu", device.is_cpu},
            {"compute_units", device.compute_units},
            {"global_memory", device.global_memory},
            {"max_allocation", device.max_allocation},
            {"chosen", chosen}};
}

ExitCode list(const CommonOptions& common) {
    const std::vector<DeviceInfo> devices = list_devices(common.device.threads);
    const std::size_t chosen = choose_device(devices, common.device.selector);
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (common.json) {
            print_event(device_event(devices[i], i == chosen));
        } else {
            print(device_text(devices[i], i == chosen));
        }
    }
    return ExitCode::ok;
}

std::string kernel_text(const KernelTest& test) {
    const std::string verdict =
        !test.failure.empty() ? "WRONG: " + test.failure
        : test.checked == 0   ? "not reached"
        : test.allowed == 0
            ? "all right"
            : fmt::format("all right, worst difference {:.1e} of {:.0e} allowed", test.worst, test.allowed);
    return fmt::format("      {:<14} {:>7} answers, {}\n", test.kernel, test.checked, verdict);
}

nlohmann::ordered_json kernel_event(int device, const KernelTest& test) {
    return {{"event", "kernel_test"},
            {"device", device},
            {"kernel", test.kernel},
            {"checked", test.checked},
            {"worst_difference", test.worst},
            {"allowed_difference", test.allowed},
            {"passed", test.failure.empty() && test.checked > 0},
            {"failure", test.failure}};
}

/// Tests one device and prints what was found; false if it failed or cannot be used at all.
bool test_one(const DeviceInfo& info, const CommonOptions& common) {
    SelfTestReport report;
    std::string failure;
    try {
        Device device({std::to_string(info.index), common.device.threads});
        take_driver_failures();
        report = run_self_test(device);
        if (const KernelTest* failed = report.failed()) failure = "kernel " + failed->kernel + " is wrong";
    } catch (const Error& error) {
        failure = error.what();
    }
    if (common.json) {
        for (const KernelTest& kernel : report.kernels) print_event(kernel_event(info.index, kernel));
        print_event({{"event", "device_test"},
                     {"device", info.index},
                     {"name", info.name},
                     {"driver", info.driver},
                     {"passed", failure.empty()},
                     {"failure", failure}});
        return failure.empty();
    }
    std::string text = fmt::format("{:>4}  {}\n      platform {}, driver {}\n", info.index, info.name,
                                   info.platform, info.driver);
    for (const KernelTest& kernel : report.kernels) text += kernel_text(kernel);
    print(text + (failure.empty() ? "      passed\n" : "      FAILED: " + failure + "\n"));
    return failure.empty();
}

/// All devices, or the one that --device names.
ExitCode test_all(const CommonOptions& common) {
    std::vector<DeviceInfo> devices = list_devices(common.device.threads);
    if (!common.device.selector.empty()) devices = {devices[choose_device(devices, common.device.selector)]};
    std::string failed;
    for (const DeviceInfo& device : devices) {
        if (!test_one(device, common)) failed += fmt::format("{}{}", failed.empty() ? "" : ", ", device.name);
    }
    if (failed.empty()) return ExitCode::ok;
    throw Error(ExitCode::device, fmt::format("failed the self-test: {}; update the driver or choose another "
                                              "device with --device",
                                              failed));
}

}  // namespace

Command add_devices_command(CLI::App& app, CommonOptions& common) {
    CLI::App* command = app.add_subcommand("devices", "lists the OpenCL devices, or tests them");
    const auto test = std::make_shared<bool>(false);
    command->add_flag(
        "--test", *test,
        "compare what each kernel computes with the host's own answers: of all devices, or of --device");
    command->footer(
        "'*' marks the device that is used; --device takes an index or a part of a name.\n"
        "Examples:\n"
        "  sahl devices\n"
        "  sahl devices --json\n"
        "  sahl devices --device 1\n"
        "  sahl devices --test");
    add_device_options(*command, common);
    add_common_options(*command, common);
    return {command, [&common, test] { return *test ? test_all(common) : list(common); }};
}

}  // namespace sahl::cli
