// Which of the machine's OpenCL devices a selector means.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "engine/device/device.h"

namespace sahl {

/// The index in `devices` (not empty) of the one that `selector` means: empty is PoCL's CPU, else
/// the first CPU, else the first device; only digits are an index; anything else is a part of a
/// device's or platform's name in either case, where a whole device name goes before parts.
/// Throws Error(device), listing the devices, when nothing matches or several do.
std::size_t choose_device(std::span<const DeviceInfo> devices, std::string_view selector);

/// One line a device: "  0: NAME (PLATFORM)".
std::string format_devices(std::span<const DeviceInfo> devices);

}  // namespace sahl
