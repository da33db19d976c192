#include "engine/device/device_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "engine/core/error.h"

namespace sahl {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = lower(c);
    return result;
}

template <class Predicate>
std::vector<DeviceInfo> select(std::span<const DeviceInfo> devices, Predicate matches) {
    std::vector<DeviceInfo> selected;
    std::copy_if(devices.begin(), devices.end(), std::back_inserter(selected), matches);
    return selected;
}

std::size_t default_device(std::span<const DeviceInfo> devices) {
    const auto place = [&](auto matches) { return std::find_if(devices.begin(), devices.end(), matches); };
    auto found = place([](const DeviceInfo& d) { return d.is_pocl && d.is_cpu; });
    if (found == devices.end()) found = place([](const DeviceInfo& d) { return d.is_cpu; });
    if (found == devices.end()) found = devices.begin();
    return static_cast<std::size_t>(found - devices.begin());
}

std::size_t device_by_index(std::span<const DeviceInfo> devices, std::string_view digits) {
    std::size_t index = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (result.ec == std::errc() && index < devices.size()) return index;
    throw Error(ExitCode::device, fmt::format("--device {}: there is no device of this index; there are:\n{}",
                                              digits, format_devices(devices)));
}

}  // namespace

std::string format_devices(std::span<const DeviceInfo> devices) {
    std::string text;
    for (const DeviceInfo& device : devices) {
        if (!text.empty()) text += '\n';
        text += fmt::format("  {}: {} ({})", device.index, device.name, device.platform);
    }
    return text;
}

std::size_t choose_device(std::span<const DeviceInfo> devices, std::string_view selector) {
    if (selector.empty()) return default_device(devices);
    if (std::all_of(selector.begin(), selector.end(), [](char c) { return c >= '0' && c <= '9'; })) {
        return device_by_index(devices, selector);
    }
    const std::string wanted = lower(selector);
    std::vector<DeviceInfo> matches =
        select(devices, [&](const DeviceInfo& d) { return lower(d.name) == wanted; });
    if (matches.empty()) {
        matches = select(devices, [&](const DeviceInfo& d) {
            return lower(d.name).find(wanted) != std::string::npos ||
                   lower(d.platform).find(wanted) != std::string::npos;
        });
    }
    if (matches.size() == 1) return static_cast<std::size_t>(matches.front().index);
    if (matches.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("--device {}: no device has this in its name; there are:\n{}", selector,
                                format_devices(devices)));
    }
    throw Error(ExitCode::device, fmt::format("--device {}: several devices match; give an index:\n{}",
                                              selector, format_devices(matches)));
}

}  // namespace sahl
