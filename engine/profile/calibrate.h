// The device's limits, measured by kernels of its own (kernels/calibrate.cl).
#pragma once

#include "engine/device/device.h"
#include "engine/profile/profile.h"

namespace sahl {

/// Of this device with as many threads as it has: from the cache folder (program_cache.h) if an earlier run
/// measured it, else measured now, which takes some tenths of a second, and kept there.
/// The memory for that, three arrays, each of at least four times the last-level cache where the device
/// gives so large ones, is part of what the device's accountant allows. Throws as Buffer and Program.
Calibration calibrate(Device& device);

/// Bytes of the largest cache of this machine's first core, 32 MiB where the system does not say.
std::size_t last_level_cache_bytes();

}  // namespace sahl
