// `sahl devices`: which OpenCL devices there are.
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/standard_output.h"
#include "engine/device/device_choice.h"

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

}  // namespace

Command add_devices_command(CLI::App& app, CommonOptions& common) {
    CLI::App* command = app.add_subcommand("devices", "lists the OpenCL devices");
    command->footer(
        "'*' marks the device that is used; --device takes an index or a part of a name.\n"
        "Examples:\n"
        "  sahl devices\n"
        "  sahl devices --json\n"
        "  sahl devices --device 1");
    add_device_options(*command, common);
    add_common_options(*command, common);
    return {command, [&common] { return list(common); }};
}

}  // namespace sahl::cli
